#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace scree {

struct PackedSphere {
    Imath::V3d center;
    double radius;
};

/// Spheres in a cube of edge `edge` around the origin that have been pushed apart until hardly any overlap by more than
/// `overlap` of the smaller radius: a bed as a soft-sphere simulation leaves it, disordered and touching.
///
/// fraction: of the cube's volume that the spheres fill; radii are drawn between `smallest` and 1, their number follows
/// from edge = (n mean volume / fraction)^(1/3). Deterministic in seed.
std::vector<PackedSphere> push_apart(uint64_t count, double fraction, double smallest, double overlap, uint64_t seed);

/// `cells`^3 copies of a periodic packing side by side, cut to `count` spheres.
std::vector<PackedSphere> repeat_packing(const std::vector<PackedSphere>& tile, double edge, int cells, uint64_t count);

/// The edge of the cube that push_apart fills.
double packing_edge(const std::vector<PackedSphere>& spheres, double fraction);

/// The largest (ri + rj - d) / min(ri, rj) over pairs, periodic images included.
double largest_overlap(const std::vector<PackedSphere>& spheres, double edge);

} // namespace scree
