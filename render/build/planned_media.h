#pragma once

#include "render/build/medium_builder.h"
#include "render/build/type_builder.h"
#include "render/stf/stf_cache.h"
#include "render/trace/world.h"

#include <memory>
#include <optional>

namespace scree {

/// Puts a medium in the place of grains where that is planned, or says that it would.
///
/// Returns from where on it stands for them, in mean radii below every face; nothing: no medium was made. Throws
/// InputError, Cancelled.
std::optional<double> make_planned_medium(const BuildContext& context, World& world);

/// Gives worlds the shells that are planned for their media; keeps the tables from one to the next.
class PlannedShells {
public:
    /// Finds how far places in media are from everything, and the shells that light may go through there; or says that
    /// it would. media: what the scene names. Throws Cancelled.
    void make(const BuildContext& context, const MediumBuilder& media, World& world);

private:
    void say(const BuildContext& context, const MediumBuilder& media, const World& world) const;

    std::unique_ptr<StfCache> cache_;
};

} // namespace scree
