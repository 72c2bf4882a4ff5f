#include "render/medium/triangle_block.h"

#include <limits>

namespace scree {

namespace {

struct Foot {
    V3d place;
    double distance;
};

/// The point of a segment that is nearest to the origin.
Foot foot_on_edge(const V3d& a, const V3d& edge)
{
    const double t = edge.dot(edge) > 0x1p-900 ? std::clamp(-a.dot(edge) / edge.dot(edge), 0.0, 1.0) : 0.0;
    const V3d p = a + edge * t;
    return {p, p.length()};
}

} // namespace

V3d TriangleBlock::nearest(size_t lane, const V3d& place) const
{
    const std::array<V3d, 3> t = triangle(lane);
    const V3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
    Foot best{V3d(0), std::numeric_limits<double>::infinity()};
    bool in = normal.dot(normal) > 0x1p-800;
    for (size_t k = 0; k < 3; ++k) {
        const V3d a = t[k] - place, edge = t[(k + 1) % 3] - t[k];
        const Foot foot = foot_on_edge(a, edge);
        if (foot.distance < best.distance) best = foot;
        in = in && normal.cross(edge).dot(a) <= 0;
    }
    return place + (in ? normal * (normal.dot(t[0] - place) / normal.dot(normal)) : best.place);
}

double TriangleBlock::distance_with_needles(const V3d& place) const
{
    // With u, M and the error of n as where there are no needles: every point of a triangle is within |n| / longest edge of one of its edges.
    double least = std::numeric_limits<double>::infinity();
    for (size_t lane = 0; lane < lanes; ++lane) {
        const std::array<V3d, 3> t = triangle(lane);
        double edges = std::numeric_limits<double>::infinity(), farthest = 0, longest = 0;
        bool in = true;
        const V3d u = t[1] - t[0], w = t[0] - t[2], normal = w.cross(u);
        for (size_t k = 0; k < 3; ++k) {
            const V3d a = t[k] - place, b = t[(k + 1) % 3] - place, edge = t[(k + 1) % 3] - t[k];
            edges = std::min(edges, foot_on_edge(a, edge).distance);
            farthest = std::max(farthest, a.length());
            longest = std::max(longest, edge.length());
            in = in && normal.dot(a.cross(b)) >= -0x1p-46 * normal.length() * a.length() * b.length();
        }
        const double rounding = 0x1p-47 * farthest + 0x1p-140, off = 0x1p-49 * u.length() * w.length();
        double distance = edges;
        if (normal.length() >= 0x1p-26 * u.length() * w.length() && normal.length() > 0x1p-400) {
            if (in) distance = std::min(edges, (std::abs(normal.dot(t[0] - place)) - off * farthest) / normal.length());
        } else if (longest > 0) {
            distance -= std::min(longest, (normal.length() + off) / longest);
        }
        least = std::min(least, distance - rounding);
    }
    return std::max(0.0, least);
}

} // namespace scree
