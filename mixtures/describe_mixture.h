#pragma once

#include "mixtures/mixture_description.h"

#include <map>
#include <optional>
#include <string>

namespace scree {

/// The mixture in words, a line per statement and a level of indentation per level of the tree.
std::string words_of_mixture(const MixtureDescription& mixture);

/// The fraction of each grain type that the description leads one to expect, by number over unbounded space; nothing
/// where it depends on the spheres (explicit, radius, grid, layers without end).
///
/// Those of perlin with `threshold` come from the noise's distribution (standard error below 0.0007).
std::optional<std::map<std::string, double>> expected_fractions(const MixtureDescription& mixture);

} // namespace scree
