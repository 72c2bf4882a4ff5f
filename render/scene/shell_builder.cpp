#include "render/scene/shell_builder.h"

#include "ingest/triangle_mesh.h"
#include "render/stf/medium_shells.h"

#include <fmt/format.h>

namespace scree {

namespace {

constexpr double largest_radius = 1024; ///< mean free paths

/// How many shells of a medium there is use for. inside: no shell in there is larger.
size_t useful_shells(const HomogeneousMedium& medium, double inside)
{
    const double albedo = max_component(medium.albedo()), g = medium.phase().mean_cosine();
    // Beyond some 20 decay lengths of a diffusing medium nothing is left to go on with; smaller shells do as well.
    const double decay = std::sqrt(3 * (1 - albedo) * (1 - albedo * g)), most = decay > 0 ? std::min(largest_radius, std::max(1.0, 20 / decay)) : largest_radius;
    const size_t all = static_cast<size_t>(std::ceil(std::log2(largest_radius) * Stf::steps_per_octave)) + 1;
    return static_cast<size_t>(Stf::largest(std::min(most, inside * medium.sigma_t().x), all) + 1);
}

} // namespace

std::shared_ptr<const ClearanceField> make_clearance(const World& world, const Progress& progress)
{
    if (world.regions.empty()) return nullptr;
    const bool among_grains = world.has_grains() && !std::ranges::all_of(world.regions, &MediumRegion::instead_of_grains);
    if (among_grains) return nullptr;
    std::vector<TriangleView> meshes;
    Imath::Box3d box;
    for (const MediumRegion& region : world.regions) {
        meshes.push_back({region.positions, region.triangles});
        for (const V3f& p : region.positions) box.extendBy(V3d(p));
    }
    for (const Surface& surface : world.surfaces) meshes.push_back({surface.positions, surface.triangles});
    std::vector<std::vector<V3f>> corners; // of lights; that of a sphere as of a cube around it
    corners.reserve(world.lights.lights().size());
    static constexpr std::array<std::array<uint32_t, 3>, 2> rectangle{{{0, 1, 2}, {1, 3, 2}}};
    static const TriangleMesh cube = box_mesh(V3d(-1), V3d(1));
    for (const Light& light : world.lights.lights()) {
        if (light.kind == LightKind::rectangle) {
            corners.push_back({V3f(light.corner), V3f(light.corner + light.edge1), V3f(light.corner + light.edge2), V3f(light.corner + light.edge1 + light.edge2)});
            meshes.push_back({corners.back(), rectangle});
        } else if (light.kind == LightKind::sphere) {
            if (box.intersects(Imath::Box3d(light.center - V3d(light.radius), light.center + V3d(light.radius)))) return nullptr; // a place may be within the cube
            corners.emplace_back();
            for (const V3d& p : cube.positions) corners.back().emplace_back(light.center + light.radius * p);
            meshes.push_back({corners.back(), cube.triangles});
        }
    }
    return std::make_shared<ClearanceField>(meshes, box, progress);
}

void add_shells(StfForm form, StfCache& cache, World& world, std::vector<PartReport>& parts, std::vector<std::string>& remarks, const Progress& progress)
{
    for (MediumRegion& region : world.regions) {
        const std::string part = "shells of '" + region.name + "'";
        const auto skip = [&](const char* why) { parts.push_back({part, false, why}); };
        if (!world.clearance) {
            skip("grains may be met in it");
            continue;
        }
        if (!region.is_achromatic()) {
            skip("its extinction depends on the channel");
            continue;
        }
        Imath::Box3d box;
        for (const V3f& p : region.positions) box.extendBy(V3d(p));
        const V3d extent = box.size();
        const double inside = std::min(0.5 * std::min({extent.x, extent.y, extent.z}), world.clearance->largest());
        if (!region.homogeneous) {
            skip("it is not the same everywhere");
            continue;
        }
        const Stopwatch watch;
        const size_t count = useful_shells(*region.homogeneous, inside);
        if (count == 0) {
            skip("no shell fits, the medium is thinner than a mean free path");
            continue;
        }
        StfCache::Found found;
        const std::shared_ptr<const PhaseTable> table = form >= StfForm::hg ? nullptr : region.homogeneous->phase_table();
        if (form == StfForm::diffusion) found.stf = std::make_shared<Stf>();
        else found = cache.find(region.homogeneous->phase().mean_cosine(), table, count, progress);
        if (!found.remark.empty()) remarks.push_back(found.remark);
        auto shells = std::make_shared<MediumShells>(found.stf, *region.homogeneous, count, form);
        parts.push_back({part, true, fmt::format("{} of up to {:.4g} mean free paths, {} made now", count, Stf::radius(count - 1), found.computed), watch.seconds(), shells->bytes()});
        region.shells = std::move(shells);
    }
}

} // namespace scree
