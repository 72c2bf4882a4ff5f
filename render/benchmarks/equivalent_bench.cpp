// The media that represent packings of equal spheres, by formula and by walks among proxies; lengths in radii, one
// core. usage: equivalent_bench [scatterings a walk, default 600000] [GSDF error, default 0.03]

#include "render/equivalent/continuous_equivalent.h"
#include "render/grains/library/grain_library.h"
#include "render/gsdf/gsdf_builder.h"
#include "tests/builders/scenes.h"
#include "tests/builders/tile_beds.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cstdlib>

int main(int argc, char** argv)
{
    using namespace scree;
    const auto scatterings = static_cast<uint64_t>(argc > 1 ? std::atof(argv[1]) : 6e5);
    const double error = argc > 2 ? std::atof(argv[2]) : 0.03;
    const EmbreeDevice device;
    Material absorbing = dielectric(1.5);
    absorbing.absorption = Color(0.05f);
    const LibraryGrain& sugar = *find_library_grain("sugar");
    Material sugar_material = sugar.material;
    sugar_material.absorption *= static_cast<Real>(sugar.typical_radius);
    const auto sugar_shape =
        std::make_shared<const Exemplar>(device, make_grain_shape(sugar, {0, 2000, {}}, "sugar"), "sugar");
    const auto glass = build_gsdf({nullptr, dielectric(1.5)}, {error});
    const std::vector<GrainType> types{
        {"white 0.9", lambert(0.9f), nullptr, build_gsdf({nullptr, lambert(1)}, {error})},
        {"glass", dielectric(1.5), nullptr, glass},
        {"absorbing", absorbing, nullptr, glass},
        {"sugar", sugar_material, sugar_shape, build_gsdf({sugar_shape.get(), sugar_material}, {error})}};
    const tbb::global_control one_core(tbb::global_control::max_allowed_parallelism, 1);
    fmt::print("{:10} {:>4} {:>7} {:>7} | {:>8} {:>8} {:>7} {:>7} | {:>8} {:>8} {:>5} {:>8} {:>8} {:>5} {:>7} {:>7} | "
               "{:>7} {:>8} {:>8} {:>6} {:>8} | {:>8} {:>8} {:>8} | {:>6} {:>5} {:>5}\n",
               "type", "f", "l", "g", "D form", "l* form", "s_t", "g_eff", "D walk", "D half", "+-%", "l* walk",
               "l* half", "+-%", "s_t", "g_eff", "albedo", "kappa", "check", "+-%", "alb_eff", "k plain", "k form",
               "k walk", "void", "left", "s");
    for (const GrainType& type : types) {
        const GrainMoments moments = grain_moments(*type.gsdf);
        const GrainShare share{type.gsdf.get(), &moments, type.material, 1, 1};
        for (const double f : {0.1, 0.3, 0.5, 0.6}) {
            const MixtureMoments mixture = mixture_moments({&share, 1}, f);
            const TileBed bed(sphere_tile(f, 1000), 1, type, 200 * mixture.flight);
            PackingWalkOptions options;
            options.scatterings = scatterings;
            options.memory = static_cast<uint32_t>(argc > 3 ? std::atoi(argv[3]) : 0);
            options.start_radius = 0.2 * bed.half();
            options.safe_radius = 0.95 * bed.half();
            const PackingWalk walk = walk_packing(bed.world(), bed.tracer(), options);
            const auto plain = continuous_equivalent(mixture, EquivalentForm::plain),
                       formula = continuous_equivalent(mixture, EquivalentForm::formula);
            const auto walked = continuous_equivalent(mixture, EquivalentForm::walk, &walk),
                       decay = continuous_equivalent(mixture, EquivalentForm::decay, &walk);
            const auto per_cent = [](const Measured& m) { return m.value > 0 ? 100 * m.error / m.value : 0; };
            const PackingDecay& deep = walk.decay[0];
            fmt::print("{:10} {:4.1f} {:7.4f} {:7.4f} | {:8.4f} {:8.4f} {:7.4f} {:7.4f} | {:8.4f} {:8.4f} {:5.2f} "
                       "{:8.4f} {:8.4f} {:5.2f} {:7.4f} {:7.4f} | {:7.5f} {:8.5f} {:8.5f} {:6.2f} {:8.5f} | {:8.5f} "
                       "{:8.5f} {:8.5f} | {:6.3f} {:5} {:5.2f} {}\n",
                       type.name, f, mixture.flight, mixture.g, formula.diffusivity, formula.transport_length,
                       formula.sigma_t, formula.g, walk.diffusivity.value, walk.half_diffusivity.value,
                       per_cent(walk.diffusivity), walk.transport_length.value, walk.half_transport_length.value,
                       per_cent(walk.transport_length), walked.sigma_t, walked.g, mixture.albedo.x, deep.kappa.value,
                       deep.check.value, per_cent(deep.kappa), decay.albedo.x, plain.decay.x, formula.decay.x,
                       walked.decay.x, walk.void_flight.value / mixture.void_flight, walk.left, walk.seconds,
                       decay.doubt);
            std::fflush(stdout);
        }
    }
    return 0;
}
