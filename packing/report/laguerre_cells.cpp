#include "packing/report/laguerre_cells.h"

#include "base/error.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace scree {

using Imath::V3d;

namespace {

constexpr uint64_t most_cells = 100'000, most_points = 500'000;
constexpr int64_t outer = -1; // a sphere or image whose own cell is not needed

/// The vertex of the tessellation that is dual to a tetrahedron, and its power distance from the four spheres.
struct DualVertex {
    V3d place{0};
    double power = 0;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase =
    CGAL::Triangulation_vertex_base_with_info_3<int64_t, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<DualVertex, Kernel, CGAL::Regular_triangulation_cell_base_3<Kernel>>;
using Triangulation = CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using WeightedPoint = Triangulation::Weighted_point;

V3d place_of(const WeightedPoint& p) { return {p.x(), p.y(), p.z()}; }

/// Solves a_i . x = b_i by Cramer's rule.
template <class T>
std::array<T, 3> solve(const std::array<std::array<T, 3>, 3>& a, const std::array<T, 3>& b, const T& determinant)
{
    std::array<T, 3> x;
    for (size_t k = 0; k < 3; ++k) {
        auto m = a;
        for (size_t i = 0; i < 3; ++i) m[i][k] = b[i];
        x[k] = (m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])) /
               determinant;
    }
    return x;
}

template <class T>
T determinant_of(const std::array<std::array<T, 3>, 3>& a)
{
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

/// The point of equal power to four spheres, relative to the first one: 2 (p_i - p_0) . x = |p_i - p_0|^2 - w_i + w_0.
template <class T>
std::array<T, 3> equal_power(const std::array<WeightedPoint, 4>& p, T& determinant)
{
    std::array<std::array<T, 3>, 3> a;
    std::array<T, 3> b;
    for (size_t i = 0; i < 3; ++i) {
        a[i] = {T(p[i + 1].x()) - T(p[0].x()), T(p[i + 1].y()) - T(p[0].y()), T(p[i + 1].z()) - T(p[0].z())};
        b[i] = (a[i][0] * a[i][0] + a[i][1] * a[i][1] + a[i][2] * a[i][2] - T(p[i + 1].weight()) + T(p[0].weight())) /
               T(2);
    }
    determinant = determinant_of(a);
    if (determinant == T(0)) return {T(0), T(0), T(0)};
    return solve(a, b, determinant);
}

bool before(const V3d& a, const V3d& b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }

/// The dual vertex, the same to the last bit for any order of the points.
DualVertex dual_vertex(std::array<WeightedPoint, 4> p)
{
    std::ranges::sort(p,
                      [](const WeightedPoint& a, const WeightedPoint& b) { return before(place_of(a), place_of(b)); });
    double determinant = 0;
    std::array<double, 3> x = equal_power(p, determinant);
    double edges = 1;
    for (size_t i = 1; i < 4; ++i) edges *= (place_of(p[i]) - place_of(p[0])).length();
    // Lattices have many flat tetrahedra. Their dual vertices are well defined, but rounding would put them anywhere.
    if (std::abs(determinant) < 1e-4 * edges) {
        CGAL::Exact_rational exact_determinant(0);
        const auto exact = equal_power(p, exact_determinant);
        for (size_t k = 0; k < 3; ++k) x[k] = CGAL::to_double(exact[k]);
    }
    const V3d relative(x[0], x[1], x[2]);
    return {place_of(p[0]) + relative, relative.length2() - p[0].weight()};
}

/// The spheres whose cells are needed, and all spheres that are near enough to bound these cells.
struct Neighbourhood {
    Imath::Box3d known; ///< every sphere with its centre in here is among the points
    std::vector<std::pair<WeightedPoint, int64_t>> points;
};

Neighbourhood neighbourhood_of(const PackedSpheres& spheres, const std::vector<uint64_t>& block, double margin)
{
    Neighbourhood result;
    for (const uint64_t i : block) result.known.extendBy(spheres.position(i));
    const V3d origin = result.known.center();
    result.known.min -= V3d(margin);
    result.known.max += V3d(margin);
    const auto add = [&](uint64_t i, const V3d& centre, int64_t info) {
        const V3d p = centre - origin;
        result.points.emplace_back(WeightedPoint(Kernel::Point_3(p.x, p.y, p.z), spheres.radius(i) * spheres.radius(i)),
                                   info);
    };
    for (size_t k = 0; k < block.size(); ++k) add(block[k], spheres.position(block[k]), static_cast<int64_t>(k));
    spheres.visit_box(result.known, [&](uint64_t i, const V3d& centre) {
        // The sphere itself (except for rounding), not an image: no period is shorter than the largest radius.
        const bool own = (centre - spheres.position(i)).length() < 0.5 * spheres.largest_radius();
        if (!own || !std::ranges::binary_search(block, i)) add(i, centre, outer);
    });
    result.known.min -= origin;
    result.known.max -= origin;
    return result;
}

struct Cells {
    std::vector<double> volume;
    std::vector<uint8_t> present, bounded;
};

/// Area of a convex polygon seen along a direction; the same to the last bit for any first corner and orientation.
double area_across(std::vector<V3d>& polygon, const V3d& direction)
{
    std::rotate(polygon.begin(), std::ranges::min_element(polygon, before), polygon.end());
    if (before(polygon.back(), polygon[1])) std::reverse(polygon.begin() + 1, polygon.end());
    double twice = 0;
    for (size_t k = 1; k + 1 < polygon.size(); ++k)
        twice += (polygon[k] - polygon[0]).cross(polygon[k + 1] - polygon[0]).dot(direction);
    return 0.5 * std::abs(twice);
}

Cells cells_of(const Neighbourhood& neighbourhood, size_t count, double largest_radius, const Progress& progress)
{
    Triangulation triangulation(neighbourhood.points.begin(), neighbourhood.points.end());
    if (progress.cancelled()) throw Cancelled();
    progress.update("Laguerre cells", 0.5);
    Cells result{std::vector<double>(count), std::vector<uint8_t>(count), std::vector<uint8_t>(count, 1)};
    for (const auto vertex : triangulation.finite_vertex_handles())
        if (vertex->info() != outer) result.present[static_cast<size_t>(vertex->info())] = 1;
    const auto spoil = [&](Triangulation::Vertex_handle v) {
        if (!triangulation.is_infinite(v) && v->info() != outer) result.bounded[static_cast<size_t>(v->info())] = 0;
    };
    if (triangulation.dimension() < 3) {
        std::ranges::fill(result.bounded, uint8_t{0});
        return result;
    }
    for (const auto cell : triangulation.all_cell_handles()) {
        bool safe = !triangulation.is_infinite(cell);
        if (safe) {
            std::array<WeightedPoint, 4> p;
            for (int k = 0; k < 4; ++k) p[static_cast<size_t>(k)] = cell->vertex(k)->point();
            cell->info() = dual_vertex(p);
            // No unknown sphere may have less power at this vertex than these four.
            const V3d& c = cell->info().place;
            const V3d below = c - neighbourhood.known.min, above = neighbourhood.known.max - c;
            const double clear = std::min({below.x, below.y, below.z, above.x, above.y, above.z});
            safe = clear > 0 && clear * clear - largest_radius * largest_radius >= cell->info().power;
        }
        if (safe) continue;
        for (int k = 0; k < 4; ++k) spoil(cell->vertex(k));
    }
    // CGAL's order depends on addresses, so the sums are taken in an order of their own.
    std::vector<std::pair<size_t, double>> cones;
    std::vector<V3d> polygon;
    uint64_t edges = 0;
    for (auto edge = triangulation.finite_edges_begin(); edge != triangulation.finite_edges_end(); ++edge) {
        if (++edges % 4096 == 0 && progress.cancelled()) throw Cancelled();
        auto v = edge->first->vertex(edge->second), w = edge->first->vertex(edge->third);
        if (v->info() == outer && w->info() == outer) continue;
        if (before(place_of(w->point()), place_of(v->point()))) std::swap(v, w);
        // The face between two cells is a polygon around the edge; a cell is a union of cones over its faces.
        polygon.clear();
        bool whole = true;
        const Triangulation::Cell_circulator first = triangulation.incident_cells(*edge);
        Triangulation::Cell_circulator here = first;
        do {
            if (triangulation.is_infinite(here)) whole = false;
            polygon.push_back(here->info().place);
        } while (++here != first);
        const V3d p = place_of(v->point()), along = place_of(w->point()) - p;
        const double d = along.length();
        if (!whole || !(d > 0)) continue;
        const double face = area_across(polygon, along / d),
                     height = 0.5 * (d * d + v->point().weight() - w->point().weight()) / d;
        if (v->info() != outer) cones.emplace_back(static_cast<size_t>(v->info()), face * height / 3);
        if (w->info() != outer) cones.emplace_back(static_cast<size_t>(w->info()), face * (d - height) / 3);
    }
    std::ranges::sort(cones);
    for (const auto& [cell, volume] : cones) result.volume[cell] += volume;
    return result;
}

} // namespace

LaguerreCells measure_laguerre_cells(const PackedSpheres& spheres, double number_density, const Progress& progress)
{
    LaguerreCells result;
    if (!(number_density > 0)) return result;
    progress.update("Laguerre cells", 0);
    // The spheres that bound each cell must be known, even where the spheres end at a surface.
    const double spacing = 1 / std::cbrt(number_density);
    std::vector<uint64_t> block = spheres.central_block(most_cells, 2 * spacing);
    if (block.empty()) return result;
    double margin = 2.5 * spacing + spheres.largest_radius();
    Cells cells;
    for (int attempt = 0;;) {
        const Neighbourhood neighbourhood = neighbourhood_of(spheres, block, margin);
        if (neighbourhood.points.size() > most_points && block.size() > 100) {
            // A sphere much larger than the others has a long reach.
            block = spheres.central_block(block.size() / 2, 2 * spacing);
            continue;
        }
        cells = cells_of(neighbourhood, block.size(), spheres.largest_radius(), progress);
        if (++attempt == 4 || std::ranges::find(cells.bounded, uint8_t{0}) == cells.bounded.end()) break;
        margin *= 1.5;
    }
    double sum2 = 0; // of squared deviations from the running mean (Welford)
    result.least = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < block.size(); ++k) {
        if (!cells.present[k]) {
            ++result.hidden;
            continue;
        }
        if (!cells.bounded[k]) {
            ++result.unbounded;
            continue;
        }
        const double r = spheres.radius(block[k]), volume = 4.0 / 3 * std::numbers::pi * r * r * r,
                     local = volume / cells.volume[k];
        ++result.cells;
        result.cell_volume += cells.volume[k];
        result.sphere_volume += volume;
        const double delta = local - result.mean;
        result.mean += delta / double(result.cells);
        sum2 += delta * (local - result.mean);
        result.least = std::min(result.least, local);
        result.greatest = std::max(result.greatest, local);
        ++result.counts[std::min(static_cast<size_t>(local / LaguerreCells::bin_width), result.counts.size() - 1)];
    }
    const bool all = block.size() == spheres.size() && result.unbounded == 0;
    result.whole_box = all && spheres.container() == PackedSpheres::Container::periodic_box;
    if (result.cells == 0) result.least = 0;
    if (result.cells > 1) result.deviation = std::sqrt(sum2 / double(result.cells - 1));
    progress.update("Laguerre cells", 1);
    return result;
}

} // namespace scree
