#include "render/grains/library/half_spaces.h"

#include "base/hash.h"
#include "base/math.h"

#include <stdexcept>

namespace scree {

namespace {

/// A corner of the polyhedron: where three planes meet.
struct Corner {
    std::array<size_t, 3> planes;
    V3d place;

    bool has(size_t plane) const { return planes[0] == plane || planes[1] == plane || planes[2] == plane; }
};

std::vector<Corner> corners_of(const std::vector<HalfSpace>& h)
{
    std::vector<Corner> corners;
    const size_t n = h.size();
    for (size_t i = 0; i < n; ++i) {
        for (size_t j = i + 1; j < n; ++j) {
            const V3d line = h[i].normal.cross(h[j].normal);
            for (size_t k = j + 1; k < n; ++k) {
                const double volume = line.dot(h[k].normal);
                if (std::abs(volume) < 0x1p-40) continue;
                const V3d p = (h[i].distance * h[j].normal.cross(h[k].normal) +
                               h[j].distance * h[k].normal.cross(h[i].normal) + h[k].distance * line) /
                              volume;
                bool inside = true;
                for (size_t l = 0; l < n && inside; ++l)
                    inside = l == i || l == j || l == k || h[l].normal.dot(p) < h[l].distance;
                if (inside) corners.push_back({{i, j, k}, p});
            }
        }
    }
    return corners;
}

/// The corners of one face in order around it: neighbours share a second plane. Empty if they do not close a ring.
std::vector<uint32_t> ring_of(const std::vector<Corner>& corners, size_t plane)
{
    std::vector<uint32_t> left, ring;
    for (uint32_t c = 0; c < corners.size(); ++c) {
        if (corners[c].has(plane)) left.push_back(c);
    }
    if (left.size() < 3) return {};
    ring.push_back(left.back());
    left.pop_back();
    const auto& first = corners[ring[0]].planes;
    const size_t stop = first[0] == plane ? first[1] : first[0];
    size_t through = first[0] + first[1] + first[2] - plane - stop; // the plane that the next corner shares
    while (!left.empty()) {
        const auto next = std::ranges::find_if(left, [&](uint32_t c) { return corners[c].has(through); });
        if (next == left.end()) return {};
        const auto& planes = corners[*next].planes;
        through = planes[0] + planes[1] + planes[2] - plane - through;
        ring.push_back(*next);
        left.erase(next);
    }
    return through == stop ? ring : std::vector<uint32_t>();
}

} // namespace

TriangleMesh convex_polyhedron(std::vector<HalfSpace> half_spaces)
{
    // Each plane is moved very slightly, so that no four meet in a point and rounding does not decide which points are
    // inside.
    for (size_t i = 0; i < half_spaces.size(); ++i)
        half_spaces[i].distance *= 1 + 0x1p-20 * unit_double(hash_index(i, 1));
    const std::vector<Corner> corners = corners_of(half_spaces);
    TriangleMesh mesh;
    for (const Corner& corner : corners) mesh.positions.push_back(corner.place);
    for (size_t plane = 0; plane < half_spaces.size(); ++plane) {
        const std::vector<uint32_t> ring = ring_of(corners, plane);
        double area = 0; // of the whole ring, as the sign of a sliver's area may be a rounding error
        for (size_t i = 2; i < ring.size(); ++i) {
            const V3d &a = mesh.positions[ring[0]], &b = mesh.positions[ring[i - 1]], &c = mesh.positions[ring[i]];
            area += (b - a).cross(c - a).dot(half_spaces[plane].normal);
        }
        for (size_t i = 2; i < ring.size(); ++i) {
            mesh.triangles.push_back(area > 0 ? std::array{ring[0], ring[i - 1], ring[i]}
                                              : std::array{ring[0], ring[i], ring[i - 1]});
        }
    }
    if (!is_closed_and_oriented(mesh)) throw std::logic_error("half-spaces that bound no polyhedron");
    return mesh;
}

double rounded_distance(const std::vector<HalfSpace>& half_spaces, double rounding, const V3d& direction)
{
    double largest = 0;
    for (const HalfSpace& h : half_spaces) largest = std::max(largest, h.normal.dot(direction) / h.distance);
    const double p = 1 / rounding;
    double sum = 0;
    for (const HalfSpace& h : half_spaces) {
        const double term = h.normal.dot(direction) / (h.distance * largest);
        if (term > 0) sum += std::pow(term, p);
    }
    return 1 / (largest * std::pow(sum, rounding));
}

} // namespace scree
