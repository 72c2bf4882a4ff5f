#include "render/media/triangle_block.h"

#include <limits>

namespace scree {

namespace {

/// The point of the segment from a to a + edge that is nearest to the origin.
V3d foot_on_edge(const V3d& a, const V3d& edge)
{
    const double length = edge.dot(edge), t = length > 0x1p-900 ? std::clamp(-a.dot(edge) / length, 0.0, 1.0) : 0.0;
    return a + edge * t;
}

double square_to_edge(const V3d& a, const V3d& edge)
{
    const V3d foot = foot_on_edge(a, edge);
    return foot.dot(foot);
}

} // namespace

V3d TriangleBlock::nearest(size_t lane, const V3d& place) const
{
    const std::array<V3d, 3> t = triangle(lane);
    const V3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
    V3d best(std::numeric_limits<double>::infinity());
    bool in = normal.dot(normal) > 0x1p-800;
    for (size_t k = 0; k < 3; ++k) {
        const V3d a = t[k] - place, edge = t[(k + 1) % 3] - t[k], foot = foot_on_edge(a, edge);
        if (foot.dot(foot) < best.dot(best)) best = foot;
        in = in && normal.cross(edge).dot(a) <= 0;
    }
    return place + (in ? normal * (normal.dot(t[0] - place) / normal.dot(normal)) : best);
}

double TriangleBlock::distance(size_t lane, const V3d& place) const
{
    // The same error bounds as in `squares`, with u = 2^-53 and M in place of S. Where the normal n is inaccurate,
    // every point of the triangle is within |n| / longest edge of one of its edges.
    const std::array<V3d, 3> t = triangle(lane);
    const V3d a = t[0] - place, b = t[1] - place, c = t[2] - place, u = t[1] - t[0], v = t[2] - t[1], w = t[0] - t[2],
              normal = w.cross(u);
    const double uu = u.dot(u), ww = w.dot(w), nn = normal.dot(normal), far = std::max({a.dot(a), b.dot(b), c.dot(c)});
    const double rounding = 0x1p-46 * std::sqrt(far) + 0x1p-140, slant = std::sqrt(uu * ww);
    const double inside = std::min({normal.dot(a.cross(b)), normal.dot(b.cross(c)), normal.dot(c.cross(a))}),
                 tolerance = 0x1p-48 * slant * far;
    const bool known = nn >= 0x1p-48 * uu * ww && nn > 0x1p-800;
    double plane = std::numeric_limits<double>::infinity();
    if (known && inside >= -tolerance) {
        plane = (std::abs(a.dot(normal)) - 0x1p-48 * slant * a.length()) / std::sqrt(nn);
        if (inside > tolerance) return std::max(0.0, plane - rounding);
    }
    double edges = std::sqrt(std::min({square_to_edge(a, u), square_to_edge(b, v), square_to_edge(c, w)}));
    if (!known) {
        const double longest = std::sqrt(std::max({uu, v.dot(v), ww}));
        if (longest > 0) edges -= std::min(longest, (std::sqrt(nn) + 0x1p-49 * slant) / longest);
    }
    return std::max(0.0, std::min(edges, plane) - rounding);
}

} // namespace scree
