#include "render/grains/library/dendrite.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <map>
#include <stdexcept>

namespace scree {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<uint32_t, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<bool, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_tag>;

} // namespace

TriangleMesh triangulate(const Dendrite& figure)
{
    try {
        Triangulation delaunay;
        TriangleMesh mesh;
        std::map<std::pair<double, double>, Triangulation::Vertex_handle> known;
        const auto vertex = [&](const V2d& p) {
            auto& handle = known[{p.x, p.y}];
            if (handle == Triangulation::Vertex_handle()) {
                handle = delaunay.insert(Kernel::Point_2(p.x, p.y));
                handle->info() = static_cast<uint32_t>(mesh.positions.size());
                mesh.positions.emplace_back(p.x, p.y, 0);
            }
            return handle;
        };
        const size_t n = figure.outline.size();
        for (const V2d& p : figure.outline) vertex(p);
        if (mesh.positions.size() != n) throw std::logic_error("a dendrite whose outline meets itself");
        for (size_t i = 0; i < n; ++i)
            delaunay.insert_constraint(vertex(figure.outline[i]), vertex(figure.outline[(i + 1) % n]));
        for (const auto& line : figure.middle_lines) {
            for (size_t i = 1; i < line.size(); ++i) delaunay.insert_constraint(vertex(line[i - 1]), vertex(line[i]));
        }

        // Outside is what can be reached from infinity without crossing the outline.
        for (const auto face : delaunay.all_face_handles()) face->info() = false;
        std::vector<Triangulation::Face_handle> open{delaunay.infinite_face()};
        delaunay.infinite_face()->info() = true;
        const auto on_outline = [&](Triangulation::Vertex_handle a, Triangulation::Vertex_handle b) {
            if (delaunay.is_infinite(a) || delaunay.is_infinite(b)) return false;
            const uint32_t i = a->info(), j = b->info();
            return i < n && j < n && ((i + 1) % n == j || (j + 1) % n == i);
        };
        while (!open.empty()) {
            const auto face = open.back();
            open.pop_back();
            for (int i = 0; i < 3; ++i) {
                const auto next = face->neighbor(i);
                if (next->info() || on_outline(face->vertex(Triangulation::cw(i)), face->vertex(Triangulation::ccw(i))))
                    continue;
                next->info() = true;
                open.push_back(next);
            }
        }
        for (const auto face : delaunay.finite_face_handles()) {
            if (!face->info())
                mesh.triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
        }
        // CGAL's containers are ordered by addresses, which vary from run to run; the vertex numbers do not.
        for (auto& t : mesh.triangles) std::ranges::rotate(t, std::ranges::min_element(t));
        std::ranges::sort(mesh.triangles);
        return mesh;
    } catch (const CGAL::Failure_exception&) {
        throw std::logic_error("a dendrite whose limbs cross");
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
        throw std::logic_error("a dendrite whose limbs cross");
    }
}

} // namespace scree
