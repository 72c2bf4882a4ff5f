#pragma once

#include "render/equivalent/core_region.h"

namespace scree {

/// Whether every edge of a triangle has an opposite edge: the condition for a closed surface, also where more than two
/// faces share an edge.
bool is_balanced(const RegionSurface& surface);

double surface_area(const RegionSurface& surface);
/// The volume by the divergence theorem; the volume in shells that face inwards is subtracted.
double surface_volume(const RegionSurface& surface);

/// The winding number of a closed surface around a point that is not on it: 0 outside and in its cavities (solid angles
/// of triangles: van Oosterom and Strackee 1983).
int winding_number(const RegionSurface& surface, const V3d& place);

/// Removes the shells of `inset` that lie in cavities of `surface`, as cavities are outside. Every point on the surface
/// of `inset` must be at distance `depth` from `surface`.
void drop_shells_in_cavities(const RegionSurface& surface, double depth, RegionSurface& inset);

} // namespace scree
