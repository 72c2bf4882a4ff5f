#pragma once

#include "mixtures/mixture_description.h"

#include <map>
#include <optional>
#include <string>

namespace scree {

/// The mixture in words: one line per statement, indented by the depth in the tree.
std::string words_of_mixture(const MixtureDescription& mixture);

/// The expected fraction of each grain type, by number over unbounded space; nothing where the fractions depend on the
/// spheres (explicit, radius, grid, layers that do not repeat).
///
/// The fractions of perlin with `threshold` come from the noise's distribution (standard error below 0.0007).
std::optional<std::map<std::string, double>> expected_fractions(const MixtureDescription& mixture);

} // namespace scree
