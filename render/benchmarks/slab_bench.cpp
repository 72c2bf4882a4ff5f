// Reflectance and transmittance of slabs of packed spheres of radius 1: explicit grains against the media that
// represent them. usage: slab_bench [paths, default 20000] [thickness, default 10] [fractions, default 0.1,0.3,0.5,0.6]
// [grains, default all] [ept|ppt]

#include "mixtures/single_mixture.h"
#include "render/build/part_report.h"
#include "render/equivalent/continuous_equivalent.h"
#include "render/grains/library/grain_library.h"
#include "render/gsdf/gsdf_builder.h"
#include "render/integrators/path_tracer.h"
#include "render/media/homogeneous_medium.h"
#include "render/scene/scene_description.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/builders/statistics.h"
#include "tests/builders/tile_beds.h"

#include <fmt/format.h>

#include <map>
#include <tbb/parallel_for.h>

#include <cstdlib>
#include <sstream>

namespace {

using namespace scree;

struct Slab {
    World world;
    std::unique_ptr<Tracer> tracer;
};

constexpr double wide = 40; // half its width over its thickness

MediumRegion region(const V3d& lo, const V3d& hi, const ContinuousEquivalent& medium)
{
    const TriangleMesh mesh = box_mesh(lo, hi);
    MediumRegion region{"slab", {}, mesh.triangles, nullptr, nullptr, true};
    for (const V3d& p : mesh.positions) region.positions.emplace_back(p);
    region.medium = std::make_shared<HomogeneousMedium>(V3d(medium.sigma_t), Color(V3f(medium.albedo)), medium.g);
    return region;
}

/// Grains at least `depth` from the faces are replaced by the medium. medium null: all are grains; depth negative: the
/// medium alone, one radius inside the faces.
std::unique_ptr<Slab> make_slab(double thickness, double fraction, const GrainType& type,
                                const ContinuousEquivalent* medium, double depth)
{
    auto slab = std::make_unique<Slab>();
    const double half = wide * thickness;
    const V3d lo(-half, -half, -0.5 * thickness), hi(half, half, 0.5 * thickness); // a fill is centred on its domain
    slab->world.types.push_back(type);
    if (depth >= 0 || !medium) {
        const auto fill = std::make_shared<ProceduralFill>(std::make_shared<const Domain>(box_mesh(lo, hi), "slab"),
                                                           sphere_tile(fraction, 1000), FillOptions{1, 0});
        slab->world.fill = std::make_shared<GrainFill>(fill, std::make_shared<SingleMixture>(0), slab->world.space);
        slab->world.domain = fill->domain().bounds();
    }
    if (medium) {
        const V3d inset(depth >= 0 ? depth : 1);
        slab->world.regions.push_back(region(lo + inset, hi - inset, *medium));
    }
    Light light;
    slab->world.lights = LightSet({light}, 1);
    slab->tracer = std::make_unique<Tracer>(std::make_shared<EmbreeDevice>(), slab->world);
    return slab;
}

struct Figures {
    Estimate reflected, passed;
    double seconds = 0;
};

Figures shine(const Slab& slab, double thickness, uint32_t paths, double cosine, uint32_t explicit_grains,
              uint64_t seed)
{
    std::vector<std::pair<float, bool>> values(paths);
    const Stopwatch watch;
    tbb::parallel_for(uint32_t{0}, paths, [&](uint32_t p) {
        flush_subnormals();
        Sampler sampler(seed, p, 0, 0);
        const V3d d(std::sqrt(1 - cosine * cosine), 0, -cosine);
        const double u = sampler.next(), v = sampler.next();
        const double reach = 0.5 * wide * thickness; // many places, so that no single packing shows
        const V3d target(reach * (2 * u - 1), reach * (2 * v - 1), 0.5 * thickness);
        PathOptions options;
        options.explicit_grains = explicit_grains;
        const PathResult result = trace_path(slab.world, *slab.tracer, target - 2 / cosine * d, d, sampler, options);
        values[p] = {result.radiance.x, result.last_direction.z > 0};
    });
    Figures figures;
    for (const auto& [value, up] : values) {
        figures.reflected.add(up ? value : 0);
        figures.passed.add(up ? 0 : value);
    }
    figures.seconds = watch.seconds();
    return figures;
}

void print_row(const std::string& what, const Figures& figures, const Figures& exact)
{
    const auto against = [](const Estimate& e, const Estimate& truth) {
        return fmt::format("{:+7.2f} +-{:5.2f}", 100 * (e.mean() / truth.mean() - 1),
                           100 * std::hypot(e.standard_error(), truth.standard_error()) / truth.mean());
    };
    fmt::print("    {:22} R {:.5f} {} %   T {:.5f} {} %  {:6.2f} s\n", what, figures.reflected.mean(),
               against(figures.reflected, exact.reflected), figures.passed.mean(),
               against(figures.passed, exact.passed), figures.seconds);
    std::fflush(stdout);
}

std::vector<double> numbers(const std::string& list)
{
    std::vector<double> all;
    std::istringstream in(list);
    for (std::string word; std::getline(in, word, ',');) all.push_back(std::atof(word.c_str()));
    return all;
}

} // namespace

int main(int argc, char** argv)
{
    const auto argument = [&](int i, const char* absent) { return std::string(argc > i ? argv[i] : absent); };
    const auto paths = static_cast<uint32_t>(std::atof(argument(1, "20000").c_str()));
    const double thickness = std::atof(argument(2, "10").c_str());
    const std::string wanted = argument(4, "all");
    const uint32_t as_they_are = argument(5, "ept") == "ept" ? all_grains : 0;
    const auto depths = numbers(argument(6, "1,2,4,8"));
    const auto cosines = numbers(argument(7, "1,0.5,0.2"));

    const EmbreeDevice device;
    Material tinted = dielectric(1.5);
    tinted.absorption = Color(0.05f);
    const LibraryGrain& sugar = *find_library_grain("sugar");
    Material sugar_material = sugar.material;
    sugar_material.absorption *= static_cast<Real>(sugar.typical_radius);
    const auto sugar_shape =
        std::make_shared<const Exemplar>(device, make_grain_shape(sugar, {0, 2000, {}}, "sugar"), "sugar");
    std::vector<GrainType> types{{"white 0.9", lambert(0.9f), nullptr},
                                 {"glass", dielectric(1.5), nullptr},
                                 {"absorbing", tinted, nullptr},
                                 {"sugar", sugar_material, sugar_shape}};
    for (GrainType& type : types) {
        if (wanted != "all" && wanted.find(type.name) == std::string::npos) continue;
        type.gsdf = build_gsdf({type.exemplar.get(), type.material}, {0.03});
        const GrainMoments moments = grain_moments(*type.gsdf);
        const GrainShare share{type.gsdf.get(), &moments, type.material, 1, 1};
        for (const double f : numbers(argument(3, "0.1,0.3,0.5,0.6"))) {
            const MixtureMoments mixture = mixture_moments({&share, 1}, f);
            const TileBed bed(sphere_tile(f, 1000), 1, type, 200 * mixture.flight);
            PackingWalkOptions options;
            options.start_radius = 0.2 * bed.half();
            options.safe_radius = 0.95 * bed.half();
            const PackingWalk walk = walk_packing(bed.world(), bed.tracer(), options);
            std::map<EquivalentForm, ContinuousEquivalent> forms;
            for (const auto& [form, name] : medium_form_names)
                forms[form] = continuous_equivalent(mixture, form, &walk);
            const ContinuousEquivalent &plain = forms[EquivalentForm::plain], &walked = forms[EquivalentForm::walk];
            fmt::print("{}, f {}, {} radii thick; walk {:.2f} s: sigma_t {:.4f} g {:.4f} albedo {:.5f} -> {:.5f}; "
                       "plain {:.4f} {:.4f}\n",
                       type.name, f, thickness, walk.seconds, walked.sigma_t, walked.g, walked.albedo.x,
                       forms[EquivalentForm::decay].albedo.x, plain.sigma_t, plain.g);
            const auto grains = make_slab(thickness, f, type, nullptr, 0);
            for (const double cosine : cosines) {
                const Figures exact = shine(*grains, thickness, 2 * paths, cosine, as_they_are, 1);
                fmt::print(
                    "  incidence {}:              R {:.5f} +- {:.5f}        T {:.5f} +- {:.5f}          {:6.2f} s\n",
                    cosine, exact.reflected.mean(), exact.reflected.standard_error(), exact.passed.mean(),
                    exact.passed.standard_error(), exact.seconds);
                for (const auto& [form, name] : medium_form_names) {
                    print_row("medium alone, " + name,
                              shine(*make_slab(thickness, f, type, &forms[form], -1), thickness, paths, cosine, 0, 2),
                              exact);
                }
                for (const double depth : depths) {
                    if (2 * depth >= thickness) continue;
                    for (const EquivalentForm form : {EquivalentForm::walk, EquivalentForm::decay}) {
                        print_row(
                            fmt::format("grains to {} r, {}", depth, medium_form_names[form]),
                            shine(*make_slab(thickness, f, type, &forms[form], depth), thickness, paths, cosine, 0, 3),
                            exact);
                    }
                }
            }
        }
    }
    return 0;
}
