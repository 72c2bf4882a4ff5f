#include "packing/solids/domain.h"

#include "base/cgal_messages.h"
#include "packing/solids/mesh_defects.h"
#include "packing/solids/mesh_shells.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include <cmath>

namespace scree {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Imath::V3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Halfedge = Surface::Halfedge_index;

struct Soup {
    std::vector<Kernel::Point_3> points;
    std::vector<std::vector<std::size_t>> polygons;
};

/// Records what was done, if anything.
class Changes {
public:
    explicit Changes(std::vector<std::string>& words) : words_(words) {}

    /// one, several: texts for one and for several, with the count at {}.
    void add(uint64_t count, const char* one, const char* several)
    {
        if (count > 0) words_.push_back(fmt::format(fmt::runtime(count == 1 ? one : several), count));
    }

private:
    std::vector<std::string>& words_;
};

bool is_finite(const V3d& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Power of two that scales the largest finite coordinate to about 1: CGAL chooses hole fillings by areas and angles in
/// double, which overflow with the fourth powers of the coordinates.
int exponent_of(const TriangleMesh& mesh)
{
    double largest = 0;
    for (const V3d& p : mesh.positions)
        for (int k = 0; k < 3; ++k)
            if (std::isfinite(p[k])) largest = std::max(largest, std::abs(p[k]));
    return largest > 0 ? std::ilogb(largest) : 0;
}

/// The faces whose corners exist and have finite coordinates.
Soup soup_of(const TriangleMesh& mesh, int exponent, Changes& changes)
{
    Soup soup;
    for (const V3d& p : mesh.positions) {
        const V3d q = is_finite(p) ? p : V3d(0);
        soup.points.emplace_back(std::scalbn(q.x, -exponent), std::scalbn(q.y, -exponent), std::scalbn(q.z, -exponent));
    }
    uint64_t missing = 0, wild = 0, collapsed = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        if (std::max({a, b, c}) >= mesh.positions.size())
            ++missing;
        else if (!is_finite(mesh.positions[a]) || !is_finite(mesh.positions[b]) || !is_finite(mesh.positions[c]))
            ++wild;
        else
            soup.polygons.push_back({a, b, c});
    }
    changes.add(missing, "dropped {} face with a vertex that does not exist",
                "dropped {} faces with a vertex that does not exist");
    changes.add(wild, "dropped {} face with a vertex that is not finite",
                "dropped {} faces with a vertex that is not finite");
    pmp::remove_isolated_points_in_polygon_soup(soup.points, soup.polygons);
    const std::size_t twins = pmp::merge_duplicate_points_in_polygon_soup(soup.points, soup.polygons);
    changes.add(twins, "merged {} vertex with one at the same place",
                "merged {} vertices with others at the same place");
    collapsed =
        std::erase_if(soup.polygons, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    changes.add(collapsed, "dropped {} face with a repeated vertex", "dropped {} faces with a repeated vertex");
    const std::size_t copies = pmp::merge_duplicate_polygons_in_polygon_soup(soup.points, soup.polygons);
    changes.add(copies, "dropped {} face that was there already", "dropped {} faces that were there already");
    return soup;
}

/// Counts what orient_polygon_soup does; through pointers, because CGAL may copy the visitor.
struct OrientationCounter : pmp::Default_orientation_visitor {
    uint64_t *turned, *doubled;

    OrientationCounter(uint64_t& t, uint64_t& d) : turned(&t), doubled(&d) {}
    void polygon_orientation_reversed(std::size_t) { ++*turned; }
    void duplicated_vertex(std::size_t, std::size_t) { ++*doubled; }
};

void orient(Soup& soup, Changes& changes)
{
    uint64_t turned = 0, doubled = 0;
    OrientationCounter counter(turned, doubled);
    pmp::orient_polygon_soup(soup.points, soup.polygons, CGAL::parameters::visitor(counter));
    changes.add(turned, "turned {} face to agree with its neighbours",
                "turned {} faces to agree with their neighbours");
    changes.add(doubled, "doubled {} vertex where parts of the surface touch",
                "doubled {} vertices where parts of the surface touch");
}

void fill_holes(Surface& surface, Changes& changes)
{
    // For holes of up to this many edges, the best of all fillings is searched, in time cubic in the edges.
    constexpr size_t searchable = 200;
    std::vector<Halfedge> borders;
    pmp::extract_boundary_cycles(surface, std::back_inserter(borders));
    uint64_t filled = 0, edges_filled = 0, left = 0;
    for (const Halfedge border : borders) {
        size_t edges = 0;
        for (const Halfedge h : CGAL::halfedges_around_face(border, surface)) {
            static_cast<void>(h);
            ++edges;
        }
        std::vector<Surface::Face_index> faces;
        pmp::triangulate_hole(surface, border, std::back_inserter(faces),
                              CGAL::parameters::do_not_use_cubic_algorithm(edges > searchable));
        if (faces.empty()) {
            ++left;
        } else {
            ++filled;
            edges_filled += edges;
        }
    }
    if (filled > 0)
        changes.add(edges_filled, "filled a hole of {} edge",
                    filled == 1 ? "filled a hole of {} edges" : "filled holes of {} edges in all");
    changes.add(left, "could not fill {} hole", "could not fill {} holes");
}

TriangleMesh mesh_of(const Surface& surface, int exponent)
{
    TriangleMesh mesh;
    std::vector<uint32_t> number(surface.num_vertices() + surface.number_of_removed_vertices());
    for (const auto vertex : surface.vertices()) {
        number[vertex.idx()] = static_cast<uint32_t>(mesh.positions.size());
        const Kernel::Point_3& p = surface.point(vertex);
        mesh.positions.emplace_back(std::scalbn(p.x(), exponent), std::scalbn(p.y(), exponent),
                                    std::scalbn(p.z(), exponent));
    }
    for (const auto face : surface.faces()) {
        std::array<uint32_t, 3> corners{};
        size_t k = 0;
        for (const auto vertex : CGAL::vertices_around_face(surface.halfedge(face), surface))
            corners.at(k++) = number[vertex.idx()];
        mesh.triangles.push_back(corners);
    }
    return mesh;
}

/// Turns the shells that look into the solid, if the mesh has no other defect.
void turn_shells(TriangleMesh& mesh, Changes& changes)
{
    if (find_surface_defect(mesh)) return;
    const MeshShells shells = find_shells(mesh);
    const std::vector<uint32_t> inside_out = find_inside_out_shells(mesh, shells, SurfaceTree(mesh));
    std::vector<bool> turn(shells.count, false);
    for (const uint32_t face : inside_out) turn[shells.of_face[face]] = true;
    for (size_t face = 0; face < mesh.triangles.size(); ++face)
        if (turn[shells.of_face[face]]) std::swap(mesh.triangles[face][1], mesh.triangles[face][2]);
    changes.add(inside_out.size(), "turned {} shell that looked into the solid",
                "turned {} shells that looked into the solid");
}

TriangleMesh repaired(const TriangleMesh& mesh, Changes& changes)
{
    const int exponent = exponent_of(mesh);
    Soup soup = soup_of(mesh, exponent, changes);
    orient(soup, changes);
    Surface surface;
    pmp::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, surface);
    const std::size_t seams = pmp::stitch_borders(surface);
    changes.add(seams, "joined a seam of {} edge", "joined seams of {} edges");
    const auto remove_flat = [&] {
        std::vector<Surface::Face_index> flat;
        pmp::degenerate_faces(surface, std::back_inserter(flat));
        if (flat.empty()) return;
        if (!pmp::remove_degenerate_faces(surface)) return;
        changes.add(flat.size(), "removed {} face without area", "removed {} faces without area");
    };
    remove_flat();
    fill_holes(surface, changes);
    remove_flat();
    surface.collect_garbage();
    TriangleMesh result = mesh_of(surface, exponent);
    turn_shells(result, changes);
    return result;
}

} // namespace

TriangleMesh repair_mesh(const TriangleMesh& mesh, std::vector<std::string>& changes)
{
    if (find_defects(mesh).empty()) return mesh;
    silence_cgal();
    Changes said(changes);
    try {
        return repaired(mesh, said);
    } catch (const CGAL::Failure_exception&) { // a precondition of a CGAL function that no check here foresees
        changes = {"gave up: CGAL cannot work with this surface; nothing was changed"};
        return mesh;
    }
}

} // namespace scree
