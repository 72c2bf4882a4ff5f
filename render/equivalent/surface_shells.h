#pragma once

#include "render/equivalent/core_region.h"

namespace scree {

/// Whether every edge of a triangle has its opposite: what a closed surface needs, also where more than two faces meet
/// at an edge.
bool is_balanced(const RegionSurface& surface);

double surface_area(const RegionSurface& surface);
/// By the divergence theorem; what shells that face inwards enclose is taken off.
double surface_volume(const RegionSurface& surface);

/// How many times a closed surface goes around a place that is not on it: 0 outside and in its cavities (solid angles
/// of triangles: van Oosterom and Strackee 1983).
int winding_number(const RegionSurface& surface, const V3d& place);

/// Takes the shells out of `inset` that lie in cavities of `surface`, where nothing is inside. Every point of the inset
/// is `depth` from the surface.
void drop_shells_in_cavities(const RegionSurface& surface, double depth, RegionSurface& inset);

} // namespace scree
