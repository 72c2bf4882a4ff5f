#include "packing/solids/mesh_shells.h"

#include <limits>
#include <numeric>

namespace scree {

namespace {

uint32_t root_of(std::vector<uint32_t>& parent, uint32_t v)
{
    while (parent[v] != v) {
        parent[v] = parent[parent[v]];
        v = parent[v];
    }
    return v;
}

} // namespace

MeshShells find_shells(const TriangleMesh& mesh)
{
    std::vector<uint32_t> parent(mesh.positions.size());
    std::iota(parent.begin(), parent.end(), 0u);
    for (const auto& [a, b, c] : mesh.triangles) {
        parent[root_of(parent, b)] = root_of(parent, a);
        parent[root_of(parent, c)] = root_of(parent, a);
    }
    constexpr uint32_t none = std::numeric_limits<uint32_t>::max();
    std::vector<uint32_t> number(mesh.positions.size(), none);
    MeshShells shells;
    shells.of_face.reserve(mesh.triangles.size());
    for (const auto& triangle : mesh.triangles) {
        uint32_t& shell = number[root_of(parent, triangle[0])];
        if (shell == none) shell = shells.count++;
        shells.of_face.push_back(shell);
    }
    return shells;
}

std::vector<uint32_t> find_inside_out_shells(const TriangleMesh& mesh, const MeshShells& shells,
                                             const SurfaceTree& tree)
{
    std::vector<bool> told(shells.count, false);
    std::vector<uint32_t> inside_out;
    for (uint32_t face = 0; face < mesh.triangles.size(); ++face) {
        const uint32_t shell = shells.of_face[face];
        if (told[shell]) continue;
        const std::optional<bool> outward = tree.looks_outward(face);
        if (!outward) continue; // vertical: another face will tell
        told[shell] = true;
        if (!*outward) inside_out.push_back(face);
    }
    return inside_out;
}

} // namespace scree
