#include "render/equivalent/surface_shells.h"

#include <Imath/ImathBox.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <numeric>

namespace scree {

namespace {

constexpr uint32_t none = ~uint32_t{0};

struct Corners {
    V3d a, b, c;

    Corners(const RegionSurface& s, size_t triangle, const V3d& from)
        : a(V3d(s.positions[s.triangles[triangle][0]]) - from), b(V3d(s.positions[s.triangles[triangle][1]]) - from),
          c(V3d(s.positions[s.triangles[triangle][2]]) - from)
    {
    }
};

/// The connected parts of a surface.
struct Shells {
    std::vector<uint32_t> of_triangle;
    uint32_t count = 0;

    explicit Shells(const RegionSurface& surface)
    {
        std::vector<uint32_t> parent(surface.positions.size());
        std::iota(parent.begin(), parent.end(), 0u);
        const auto root = [&](uint32_t v) {
            while (parent[v] != v) v = parent[v] = parent[parent[v]];
            return v;
        };
        for (const auto& t : surface.triangles)
            for (size_t k = 1; k < 3; ++k) {
                const uint32_t a = root(t[0]), b = root(t[k]);
                parent[std::max(a, b)] = std::min(a, b);
            }
        std::vector<uint32_t> number(parent.size(), none);
        of_triangle.reserve(surface.triangles.size());
        for (const auto& t : surface.triangles) {
            uint32_t& n = number[root(t[0])];
            if (n == none) n = count++;
            of_triangle.push_back(n);
        }
    }
};

V3d middle_of(const RegionSurface& surface)
{
    Imath::Box3d bounds;
    for (const V3f& p : surface.positions) bounds.extendBy(V3d(p));
    return bounds.isEmpty() ? V3d(0) : bounds.center();
}

/// Bounds of the cavities that are wide enough for a point at distance `depth` from their walls.
std::vector<Imath::Box3d> wide_cavities(const RegionSurface& surface, double depth)
{
    const Shells shells(surface);
    const V3d middle = middle_of(surface);
    std::vector<double> volume(shells.count, 0);
    std::vector<Imath::Box3d> bounds(shells.count);
    for (size_t t = 0; t < surface.triangles.size(); ++t) {
        const Corners p(surface, t, middle);
        volume[shells.of_triangle[t]] += p.a.dot(p.b.cross(p.c));
        for (const uint32_t v : surface.triangles[t]) bounds[shells.of_triangle[t]].extendBy(V3d(surface.positions[v]));
    }
    std::vector<Imath::Box3d> wide;
    for (uint32_t shell = 0; shell < shells.count; ++shell) {
        const V3d size = bounds[shell].size();
        if (volume[shell] < 0 && std::min({size.x, size.y, size.z}) > 2 * depth) wide.push_back(bounds[shell]);
    }
    return wide;
}

} // namespace

bool is_balanced(const RegionSurface& surface)
{
    // An edge as its lower and higher vertex, and whether it goes from the lower to the higher one.
    std::vector<std::pair<uint64_t, bool>> edges;
    edges.reserve(3 * surface.triangles.size());
    for (const auto& t : surface.triangles)
        for (size_t k = 0; k < 3; ++k) {
            const auto [lower, higher] = std::minmax(t[k], t[(k + 1) % 3]);
            edges.emplace_back(uint64_t{lower} << 32 | higher, t[k] == lower);
        }
    tbb::parallel_sort(edges.begin(), edges.end());
    for (size_t begin = 0; begin < edges.size();) {
        size_t end = begin, forward = 0;
        for (; end < edges.size() && edges[end].first == edges[begin].first; ++end) forward += edges[end].second;
        if (2 * forward != end - begin) return false;
        begin = end;
    }
    return true;
}

double surface_area(const RegionSurface& surface)
{
    double sum = 0;
    for (size_t t = 0; t < surface.triangles.size(); ++t) {
        const V3d origin(surface.positions[surface.triangles[t][0]]);
        const Corners p(surface, t, origin);
        sum += p.b.cross(p.c).length() / 2;
    }
    return sum;
}

double surface_volume(const RegionSurface& surface)
{
    const V3d middle = middle_of(surface);
    double sum = 0;
    for (size_t t = 0; t < surface.triangles.size(); ++t) {
        const Corners p(surface, t, middle);
        sum += p.a.dot(p.b.cross(p.c));
    }
    return sum / 6;
}

int winding_number(const RegionSurface& surface, const V3d& place)
{
    const double angle = tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, surface.triangles.size(), 4096), 0.0,
        [&](const tbb::blocked_range<size_t>& range, double sum) {
            for (size_t t = range.begin(); t < range.end(); ++t) {
                Corners p(surface, t, place);
                // Normalised first, as squares of very small or large lengths would leave the range of numbers.
                p.a.normalize(), p.b.normalize(), p.c.normalize();
                sum += 2 * std::atan2(p.a.dot(p.b.cross(p.c)), 1 + p.a.dot(p.b) + p.b.dot(p.c) + p.c.dot(p.a));
            }
            return sum;
        },
        std::plus<>());
    return static_cast<int>(std::lround(angle / (4 * pi)));
}

void drop_shells_in_cavities(const RegionSurface& surface, double depth, RegionSurface& inset)
{
    const std::vector<Imath::Box3d> cavities = wide_cavities(surface, depth);
    if (cavities.empty()) return;
    const Shells shells(inset);
    std::vector<int> keep(shells.count, -1);
    size_t kept = 0;
    for (size_t t = 0; t < inset.triangles.size(); ++t) {
        int& known = keep[shells.of_triangle[t]];
        if (known < 0) {
            const V3d at(inset.positions[inset.triangles[t][0]]);
            const bool near =
                std::any_of(cavities.begin(), cavities.end(), [&](const Imath::Box3d& b) { return b.intersects(at); });
            known = !near || winding_number(surface, at) > 0;
        }
        if (known) inset.triangles[kept++] = inset.triangles[t];
    }
    inset.triangles.resize(kept);
    std::vector<uint32_t> renamed(inset.positions.size(), none);
    std::vector<V3f> used;
    for (auto& t : inset.triangles)
        for (uint32_t& v : t) {
            if (renamed[v] == none) {
                renamed[v] = static_cast<uint32_t>(used.size());
                used.push_back(inset.positions[v]);
            }
            v = renamed[v];
        }
    inset.positions = std::move(used);
}

} // namespace scree
