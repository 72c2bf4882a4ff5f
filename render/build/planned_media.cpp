#include "render/build/planned_media.h"

#include "render/build/grain_medium.h"
#include "render/build/shell_builder.h"
#include "render/gsdf/gsdf_cache.h"
#include "render/media/homogeneous_medium.h"

#include <fmt/format.h>

#include <algorithm>

namespace scree {

namespace {

constexpr const char* distances = "distances within media";
constexpr const char* unknown = "grains or a sphere light may lie inside a medium";
constexpr const char* stepwise = "light in media is traced from scattering to scattering";

/// An upper bound on the radius of a shell in mean free paths, from the media's boxes; infinite if a medium varies.
double largest_shell(const World& world)
{
    double largest = 0;
    for (const MediumRegion& region : world.regions) {
        const HomogeneousMedium* const uniform = region.medium->uniform();
        if (!uniform) return std::numeric_limits<double>::infinity();
        const V3d size = region.bounds().size();
        largest = std::max(largest, 0.5 * std::min({size.x, size.y, size.z}) * uniform->sigma_t().x);
    }
    return largest;
}

} // namespace

std::optional<double> make_planned_medium(const BuildContext& context, World& world)
{
    const TransportPlan& plan = context.plan;
    const auto skip = [&](const char* part, const std::string& why) { context.parts.push_back({part, false, why}); };
    if (!plan.has_grain_medium || !world.has_grains()) {
        skip("medium of the grains", world.has_grains() ? plan.why_no_medium : "the scene has no grains");
        return std::nullopt;
    }
    const bool all = plan.replaces_all;
    if (context.precompute == Precompute::never) {
        if (needs_walk(plan.medium_form))
            context.parts.push_back({"walk in the packing", true, "to be walked"});
        else
            skip("walk in the packing", "the form of the medium needs none");
        context.parts.push_back(
            {"medium of the grains", true,
             all ? "to be made, in place of all grains"
                 : fmt::format("to be made where a place lies {:g} mean radii below every face", plan.depth_radii)});
        return std::nullopt;
    }
    const GrainDepth depth{all, plan.depth_radii, plan.depth_flights};
    return replace_grains(plan.medium_form, depth, world, context.parts, context.warnings, context.progress);
}

/// Reports what make() would do, as far as this is known without building.
void PlannedShells::say(const BuildContext& context, const MediumBuilder& media, const World& world) const
{
    const TransportPlan& plan = context.plan;
    const auto skip = [&](const char* part, const std::string& why) { context.parts.push_back({part, false, why}); };
    const bool known = plan.replaces_all || !world.has_grains() || !media.has_any();
    if (known)
        context.parts.push_back({distances, true, "to be computed unless a sphere light may lie inside a medium"});
    else
        skip(distances, unknown);
    if (!plan.has_shells) return skip("shells", stepwise);
    if (!known) return skip("shells", unknown);
    const double least = std::max(1.0, plan.least_shell);
    const bool all_read = !plan.has_grain_medium && world.regions.size() == media.count(); // a plan does not read grids
    if (all_read && std::ranges::none_of(world.regions, &MediumRegion::is_achromatic))
        return skip("shells", "the extinction of every medium depends on the channel");
    if (const double largest = largest_shell(world); all_read && largest < least) {
        return skip("shells",
                    fmt::format("no shell can be larger than {:.3g} mean free paths; at least {:g} are needed", largest,
                                least));
    }
    const bool has_grids = media.count() > world.regions.size();
    context.parts.push_back(
        {"shells", true,
         fmt::format("to be made where a shell of {:g} mean free paths fits in a medium{}", least,
                     plan.shells_must_pay && has_grids ? " and, in grids, where they save work" : "")});
}

void PlannedShells::make(const BuildContext& context, const MediumBuilder& media, World& world)
{
    const TransportPlan& plan = context.plan;
    if (context.precompute == Precompute::never && (plan.has_grain_medium || media.has_any()))
        return say(context, media, world);
    const auto skip = [&](const char* part, const char* why) { context.parts.push_back({part, false, why}); };
    constexpr const char* none = "there is no medium";
    const Stopwatch watch;
    world.clearance = make_clearance(world, context.progress);
    if (world.clearance)
        context.parts.push_back(
            {distances, true, "to everything that a ray can hit there", watch.seconds(), world.clearance->bytes()});
    else
        skip(distances, world.regions.empty() ? none : unknown);
    if (world.regions.empty()) return skip("shells", none);
    if (!plan.has_shells) return skip("shells", stepwise);
    if (!cache_) cache_ = std::make_unique<StfCache>(cache_folder(), stf_options(plan.accuracy));
    add_shells({plan.stf_form, plan.least_shell, plan.shells_must_pay}, *cache_, world, context.parts, context.warnings,
               context.progress);
}

} // namespace scree
