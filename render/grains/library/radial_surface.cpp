#include "render/grains/library/radial_surface.h"

#include "base/math.h"
#include "render/grains/library/edge_split.h"

namespace scree {

namespace {

/// 20 faces, vertices on the unit sphere.
TriangleMesh icosahedron()
{
    TriangleMesh mesh;
    const double phi = std::numbers::phi, scale = 1 / std::sqrt(1 + phi * phi);
    for (const double s : {-1.0, 1.0}) {
        for (const double t : {-phi, phi})
            mesh.positions.insert(mesh.positions.end(), {V3d(0, s, t), V3d(s, t, 0), V3d(t, 0, s)});
    }
    for (V3d& p : mesh.positions) p *= scale;
    // Three vertices form a face if each pair is one edge length apart; an edge has length 2 before scaling.
    const double edge2 = 4 * scale * scale;
    const auto near = [&](uint32_t a, uint32_t b) {
        return std::abs((mesh.positions[a] - mesh.positions[b]).length2() - edge2) < 0.1;
    };
    for (uint32_t a = 0; a < 12; ++a) {
        for (uint32_t b = a + 1; b < 12; ++b) {
            for (uint32_t c = b + 1; c < 12; ++c) {
                if (!near(a, b) || !near(b, c) || !near(c, a)) continue;
                const V3d& p = mesh.positions[a];
                const bool outward = (mesh.positions[b] - p).cross(mesh.positions[c] - p).dot(p) > 0;
                mesh.triangles.push_back(outward ? std::array{a, b, c} : std::array{a, c, b});
            }
        }
    }
    return mesh;
}

uint64_t splits_to(uint64_t triangles, const TriangleMesh& mesh)
{
    return triangles > mesh.triangles.size() ? (triangles - mesh.triangles.size()) / 2 : 0;
}

/// Moves the vertices to the surface. Splitting must come before: on a bumpy surface the new edges may be longer than
/// the edge that they halve, and splitting would not end.
TriangleMesh moved_onto(const RadialFunction& radius, TriangleMesh mesh)
{
    for (V3d& p : mesh.positions) {
        const V3d d = p.normalized();
        p = d * radius(d);
    }
    return mesh;
}

} // namespace

double mean_edge(uint64_t triangles) { return std::sqrt(16 * pi / (std::sqrt(3.0) * static_cast<double>(triangles))); }

TriangleMesh radial_surface(const RadialFunction& radius, uint64_t triangles)
{
    TriangleMesh mesh = icosahedron();
    split_longest_edges(mesh, splits_to(triangles, mesh), [](const V3d& middle) { return middle.normalized(); });
    return moved_onto(radius, std::move(mesh));
}

TriangleMesh radial_surface(const RadialFunction& radius, TriangleMesh solid, uint64_t triangles)
{
    split_longest_edges(solid, splits_to(triangles, solid), [](const V3d& middle) { return middle; });
    return moved_onto(radius, std::move(solid));
}

} // namespace scree
