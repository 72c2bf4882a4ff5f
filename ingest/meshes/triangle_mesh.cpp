#include "ingest/meshes/triangle_mesh.h"

#include "base/error.h"
#include "ingest/meshes/mesh_topology.h"

#include <algorithm>

namespace scree {

namespace {

/// An edge of a face: its vertices and the direction in which the face runs along it.
struct DirectedEdge {
    uint64_t key = 0; ///< lower vertex in the high 32 bits, higher vertex in the low
    bool forward = false;

    bool operator<(const DirectedEdge& other) const { return key < other.key; }
};

std::vector<DirectedEdge> sorted_edges(const TriangleMesh& mesh)
{
    std::vector<DirectedEdge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const auto& triangle : mesh.triangles) {
        for (size_t k = 0; k < 3; ++k) {
            const auto [lower, higher] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
            edges.push_back({uint64_t{lower} << 32 | higher, triangle[k] == lower});
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

} // namespace

TriangleMesh box_mesh(const Imath::V3d& lo, const Imath::V3d& hi)
{
    TriangleMesh mesh;
    for (int k = 0; k < 8; ++k)
        mesh.positions.emplace_back(k & 1 ? hi.x : lo.x, k & 2 ? hi.y : lo.y, k & 4 ? hi.z : lo.z);
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

MeshTopology topology_of(const TriangleMesh& mesh)
{
    const std::vector<DirectedEdge> edges = sorted_edges(mesh);
    MeshTopology topology{!edges.empty(), true};
    for (size_t begin = 0; begin < edges.size();) {
        size_t end = begin;
        int64_t forward = 0;
        for (; end < edges.size() && edges[end].key == edges[begin].key; ++end) forward += edges[end].forward;
        const auto faces = static_cast<int64_t>(end - begin);
        if (faces != 2) topology.closed = false;
        // Of faces that agree, as many run along the edge forward as backward; if their number is odd, one more.
        if (std::abs(2 * forward - faces) > faces % 2) topology.oriented = false;
        begin = end;
    }
    return topology;
}

bool is_closed_and_oriented(const TriangleMesh& mesh)
{
    const MeshTopology topology = topology_of(mesh);
    return topology.closed && topology.oriented;
}

TriangleMesh read_closed_mesh(const std::filesystem::path& path, const std::string& because)
{
    TriangleMesh mesh = read_mesh(path);
    if (!is_closed_and_oriented(mesh)) {
        throw InputError(path.string(), "an open or inconsistently oriented mesh", "a closed mesh, " + because,
                         "scree info reports the defects");
    }
    if (signed_volume(mesh) < 0) {
        for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    }
    return mesh;
}

Imath::Box3d bounds_of(const TriangleMesh& mesh)
{
    Imath::Box3d bounds;
    for (const auto& triangle : mesh.triangles) {
        for (const uint32_t vertex : triangle) bounds.extendBy(mesh.positions[vertex]);
    }
    return bounds;
}

double signed_volume(const TriangleMesh& mesh)
{
    const Imath::Box3d bounds = bounds_of(mesh);
    if (bounds.isEmpty()) return 0;
    const Imath::V3d middle = bounds.min * 0.5 + bounds.max * 0.5;
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Imath::V3d p = mesh.positions[a] - middle, q = mesh.positions[b] - middle, r = mesh.positions[c] - middle;
        sum += p.dot(q.cross(r));
    }
    return sum / 6;
}

} // namespace scree
