#pragma once

#include "base/math.h"

#include <utility>
#include <vector>

namespace scree {

/// Centre and radius of the smallest sphere around the points, by CGAL. Radius 0 for no points or one.
std::pair<V3d, double> smallest_enclosing_sphere(const std::vector<V3d>& points);

} // namespace scree
