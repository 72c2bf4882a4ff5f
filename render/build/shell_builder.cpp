#include "render/build/shell_builder.h"

#include "ingest/meshes/triangle_mesh.h"
#include "render/stf/medium_shells.h"
#include "render/stf/shell_forecast.h"

#include <fmt/format.h>

namespace scree {

namespace {

constexpr double largest_radius = 1024; ///< mean free paths

/// Variation within which a medium of grids counts as uniform in a shell; a chessboard with fields 49 mean free paths
/// wide is then right to 0.2 %.
constexpr double tolerance = 0.05;
constexpr double grain_tolerance = 0.1; ///< the same for a medium of grains, which differs by chance within a shell
constexpr double thin = 0.5; ///< mean free paths over which variation averages out
/// The same for a medium of grains: the measured medium differs by chance between cubes that hold hundreds of grains.
constexpr double thin_grains = 16;
/// Work with shells over work without, at most: making the tables of the shells costs time too.
constexpr double worthwhile_work = 0.95;
constexpr double g_step = 1.3; ///< factor between values of 1 - g; the same for all scenes, so that they share tables

/// The number of useful shells. inside: upper bound on the radius of a shell in the medium.
size_t useful_shells(double sigma_t, double albedo, double g, double inside)
{
    // Beyond about 20 decay lengths of diffusion almost no light is left, so smaller shells are enough.
    const double decay = std::sqrt(3 * (1 - albedo) * (1 - albedo * g)),
                 most = decay > 0 ? std::min(largest_radius, std::max(1.0, 20 / decay)) : largest_radius;
    const size_t all = static_cast<size_t>(std::ceil(std::log2(largest_radius) * Stf::steps_per_octave)) + 1;
    return static_cast<size_t>(Stf::largest(std::min(most, inside * sigma_t), all) + 1);
}

/// Values of g from at most `low` to at least `high`.
std::vector<double> g_axis(double low, double high)
{
    constexpr double most = 0.999;
    low = std::clamp(low, -most, most);
    high = std::clamp(high, -most, most);
    constexpr double rounded = 1e-6; // the limits are in single precision
    if (high - low <= 4 * rounded) return {std::round(0.5 * (low + high) / rounded) * rounded};
    const int first = static_cast<int>(std::floor(-std::log(1 - low) / std::log(g_step))),
              last = static_cast<int>(std::ceil(-std::log(1 - high) / std::log(g_step)));
    std::vector<double> axis;
    for (int k = first; k <= last; ++k) axis.push_back(std::max(-most, 1 - std::pow(g_step, -k)));
    return axis;
}

} // namespace

StfOptions stf_options(Accuracy accuracy)
{
    StfOptions options;
    options.walks = level_of(accuracy).stf_walks;
    options.records = static_cast<uint32_t>(std::min<uint64_t>(options.records, options.walks));
    return options;
}

std::shared_ptr<const ClearanceField> make_clearance(const World& world, const Progress& progress)
{
    if (world.regions.empty()) return nullptr;
    const bool among_grains =
        world.has_grains() && !std::ranges::all_of(world.regions, &MediumRegion::instead_of_grains);
    if (among_grains) return nullptr;
    std::vector<TriangleView> meshes;
    Imath::Box3d box;
    for (const MediumRegion& region : world.regions) {
        meshes.push_back({region.positions, region.triangles});
        for (const V3f& p : region.positions) box.extendBy(V3d(p));
    }
    for (const Surface& surface : world.surfaces) meshes.push_back({surface.positions, surface.triangles});
    std::vector<std::vector<V3f>> corners; // of lights; a sphere is replaced by the cube around it
    corners.reserve(world.lights.lights().size());
    static constexpr std::array<std::array<uint32_t, 3>, 2> rectangle{{{0, 1, 2}, {1, 3, 2}}};
    static const TriangleMesh cube = box_mesh(V3d(-1), V3d(1));
    for (const Light& light : world.lights.lights()) {
        if (light.kind == LightKind::rectangle) {
            corners.push_back({V3f(light.corner), V3f(light.corner + light.edge1), V3f(light.corner + light.edge2),
                               V3f(light.corner + light.edge1 + light.edge2)});
            meshes.push_back({corners.back(), rectangle});
        } else if (light.kind == LightKind::sphere) {
            if (box.intersects(Imath::Box3d(light.center - V3d(light.radius), light.center + V3d(light.radius))))
                return nullptr; // a point of the medium may lie inside the cube
            corners.emplace_back();
            for (const V3d& p : cube.positions) corners.back().emplace_back(light.center + light.radius * p);
            meshes.push_back({corners.back(), cube.triangles});
        }
    }
    return std::make_shared<ClearanceField>(meshes, box, progress);
}

void add_shells(const ShellChoice& choice, StfCache& cache, World& world, std::vector<PartReport>& parts,
                std::vector<std::string>& remarks, const Progress& progress)
{
    for (MediumRegion& region : world.regions) {
        const std::string part = "shells of '" + region.name + "'";
        const auto skip = [&](const std::string& why) { parts.push_back({part, false, why}); };
        if (!world.clearance) {
            skip("grains or a sphere light may lie inside a medium");
            continue;
        }
        if (!region.is_achromatic()) {
            skip("its extinction depends on the channel");
            continue;
        }
        const Stopwatch watch;
        double sigma_t, albedo, g_low, g_high;
        std::unique_ptr<MediumPyramid> pyramid;
        const Imath::Box3d box = region.bounds();
        const HomogeneousMedium* const uniform = region.medium->uniform();
        if (uniform) {
            sigma_t = uniform->sigma_t().x;
            albedo = max_component(uniform->albedo());
            g_low = g_high = uniform->phase().mean_cosine();
        } else {
            pyramid = std::make_unique<MediumPyramid>(*region.medium, box,
                                                      region.instead_of_grains ? grain_tolerance : tolerance,
                                                      region.instead_of_grains ? thin_grains : thin, progress);
            const MediumPyramid::Extremes& extremes = pyramid->extremes();
            sigma_t = extremes.sigma_t_high;
            albedo = extremes.albedo_high;
            g_low = extremes.g_low;
            g_high = extremes.g_high;
        }
        const size_t count = useful_shells(
            sigma_t, albedo, g_low,
            std::min(0.5 * std::min({box.size().x, box.size().y, box.size().z}), world.clearance->largest()));
        if (count == 0 || Stf::radius(count - 1) < choice.least) {
            skip(count == 0 ? "none fits: no place is a mean free path away from all faces"
                            : fmt::format("the largest that fits has {:.3g} mean free paths; at least {:g} are needed",
                                          Stf::radius(count - 1), choice.least));
            continue;
        }
        std::string forecast;
        if (choice.must_pay && pyramid && !region.instead_of_grains) {
            const ShellForecast walks =
                forecast_shells(*region.medium, *pyramid, box, *world.clearance, count, progress);
            const double work = walks.work(world.lights.any_sampled());
            forecast = fmt::format("replace {:.0f} % of the scatterings, {:.2g} a shell, for {:.0f} % of the work",
                                   100 * walks.part(), walks.each(), 100 * work);
            if (!(work <= worthwhile_work)) {
                parts.push_back(
                    {part, false,
                     fmt::format("shells would {}; at most {:.0f} % is worthwhile", forecast, 100 * worthwhile_work),
                     watch.seconds()});
                continue;
            }
            forecast = "; they " + forecast;
        }
        std::vector<std::shared_ptr<const Stf>> stfs;
        size_t computed = 0;
        const auto add_stf = [&](double g, const std::shared_ptr<const PhaseTable>& table) {
            if (choice.form == StfForm::diffusion) {
                stfs.push_back(std::make_shared<Stf>(g));
                return;
            }
            const StfCache::Found found = cache.find(g, table, count, progress);
            if (!found.remark.empty()) remarks.push_back(found.remark);
            stfs.push_back(found.stf);
            computed += found.computed;
        };
        if (uniform) {
            add_stf(g_low, choice.form >= StfForm::hg ? nullptr : uniform->phase_table());
            region.shells = std::make_shared<MediumShells>(stfs[0], *uniform, count, choice.form);
        } else {
            for (const double g : g_axis(g_low, g_high)) add_stf(g, nullptr);
            region.shells = std::make_shared<MediumShells>(stfs, std::move(pyramid), count, choice.form);
        }
        parts.push_back({part, true,
                         fmt::format("{} of up to {:.4g} mean free paths for {} values of g, {} made now{}", count,
                                     Stf::radius(count - 1), stfs.size(), computed, forecast),
                         watch.seconds(), region.shells->bytes()});
    }
}

} // namespace scree
