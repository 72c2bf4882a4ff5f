#pragma once

#include "render/build/medium_builder.h"
#include "render/build/type_builder.h"
#include "render/stf/stf_cache.h"
#include "render/trace/world.h"

#include <memory>
#include <optional>

namespace scree {

/// Replaces grains by a medium if that is planned; with Precompute::never, only reports it.
///
/// Returns the depth at which the medium begins, in mean radii below every face; nothing if no medium was made. Throws
/// InputError, Cancelled.
std::optional<double> make_planned_medium(const BuildContext& context, World& world);

/// Gives worlds the shells that are planned for their media; keeps the tables from one world to the next.
class PlannedShells {
public:
    /// Computes the distances within media and the shells; with Precompute::never, only reports them. media: the media
    /// that the scene names. Throws Cancelled.
    void make(const BuildContext& context, const MediumBuilder& media, World& world);

private:
    void say(const BuildContext& context, const MediumBuilder& media, const World& world) const;

    std::unique_ptr<StfCache> cache_;
};

} // namespace scree
