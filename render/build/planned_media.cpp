#include "render/build/planned_media.h"

#include "render/build/grain_medium.h"
#include "render/build/shell_builder.h"
#include "render/gsdf/gsdf_cache.h"

#include <fmt/format.h>

#include <algorithm>

namespace scree {

namespace {

constexpr const char* distances = "distances within media";
constexpr const char* unknown = "grains, or a spherical light, may be met in it";
constexpr const char* stepwise = "light is followed from scattering to scattering in media";

/// Mean free paths that no shell in the media so far can have more of, by their boxes: of grids nothing is known before
/// they are read.
double largest_shell(const World& world)
{
    double largest = 0;
    for (const MediumRegion& region : world.regions) {
        if (!region.homogeneous) return std::numeric_limits<double>::infinity();
        Imath::Box3d box;
        for (const V3f& p : region.positions) box.extendBy(V3d(p));
        const V3d size = box.size();
        largest = std::max(largest, 0.5 * std::min({size.x, size.y, size.z}) * region.homogeneous->sigma_t().x);
    }
    return largest;
}

} // namespace

std::optional<double> make_planned_medium(const TypeRequest& request, World& world)
{
    const TransportPlan& plan = request.plan;
    const auto skip = [&](const char* part, const std::string& why) { request.parts.push_back({part, false, why}); };
    if (!plan.has_grain_medium || !world.has_grains()) {
        skip("medium of the grains", world.has_grains() ? plan.why_no_medium : "the scene has no grains");
        return std::nullopt;
    }
    const bool all = plan.replaces_all;
    if (request.precompute == Precompute::never) {
        if (needs_walk(plan.medium_form))
            request.parts.push_back({"walk in the packing", true, "to be walked"});
        else
            skip("walk in the packing", "the form of the medium needs none");
        request.parts.push_back(
            {"medium of the grains", true,
             all ? "to be made, in place of all grains"
                 : fmt::format("to be made, where there is a place {:g} mean radii below every face",
                               plan.depth_radii)});
        return std::nullopt;
    }
    const GrainDepth depth{all, plan.depth_radii, plan.depth_flights};
    return replace_grains(plan.medium_form, depth, world, request.parts, request.warnings, request.progress);
}

/// What make() would do, as far as it is known.
void PlannedShells::say(const TypeRequest& request, const MediumBuilder& media, const World& world) const
{
    const TransportPlan& plan = request.plan;
    const auto skip = [&](const char* part, const std::string& why) { request.parts.push_back({part, false, why}); };
    const bool known = plan.replaces_all || !world.has_grains() || !media.has_any();
    if (known)
        request.parts.push_back({distances, true, "to be found, unless a spherical light may be met in a medium"});
    else
        skip(distances, unknown);
    if (!plan.has_shells) return skip("shells", stepwise);
    if (!known) return skip("shells", unknown);
    const double least = std::max(1.0, plan.least_shell);
    const bool all_read = !plan.has_grain_medium && world.regions.size() == media.count(); // grids are not, for a plan
    if (all_read && std::ranges::none_of(world.regions, &MediumRegion::is_achromatic))
        return skip("shells", "the extinction of every medium depends on the channel");
    if (const double largest = largest_shell(world); all_read && largest < least) {
        return skip("shells", fmt::format("none can have more than {:.3g} mean free paths, of use are {:g} and more",
                                          largest, least));
    }
    const bool has_grids = media.count() > world.regions.size();
    request.parts.push_back(
        {"shells", true,
         fmt::format("to be made, where one of {:g} mean free paths fits in a medium{}", least,
                     plan.shells_must_pay && has_grids ? " and, in grids, where they save work" : "")});
}

void PlannedShells::make(const TypeRequest& request, const MediumBuilder& media, World& world)
{
    const TransportPlan& plan = request.plan;
    if (request.precompute == Precompute::never && (plan.has_grain_medium || media.has_any()))
        return say(request, media, world);
    const auto skip = [&](const char* part, const char* why) { request.parts.push_back({part, false, why}); };
    constexpr const char* none = "there is no medium";
    const Stopwatch watch;
    world.clearance = make_clearance(world, request.progress);
    if (world.clearance)
        request.parts.push_back(
            {distances, true, "from all that may be met there", watch.seconds(), world.clearance->bytes()});
    else
        skip(distances, world.regions.empty() ? none : unknown);
    if (world.regions.empty()) return skip("shells", none);
    if (!plan.has_shells) return skip("shells", stepwise);
    if (!cache_) cache_ = std::make_unique<StfCache>(cache_folder(), stf_options(plan.accuracy));
    add_shells({plan.stf_form, plan.least_shell, plan.shells_must_pay}, *cache_, world, request.parts, request.warnings,
               request.progress);
}

} // namespace scree
