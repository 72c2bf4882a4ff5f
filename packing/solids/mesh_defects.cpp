#include "packing/solids/mesh_defects.h"

#include "ingest/meshes/polygons.h"
#include "ingest/meshes/self_intersections.h"
#include "packing/solids/mesh_shells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

using Imath::V3d;
using Kind = MeshDefect::Kind;

const char* const repair_hint = "--repair may fix it";

std::string words_of(const V3d& p) { return fmt::format("({}, {}, {})", p.x, p.y, p.z); }

std::string words_of_face(const TriangleMesh& mesh, size_t face)
{
    const auto& [a, b, c] = mesh.triangles[face];
    return fmt::format("face {} (vertices {}, {}, {} at {}, {}, {})", face, a, b, c, words_of(mesh.positions[a]),
                       words_of(mesh.positions[b]), words_of(mesh.positions[c]));
}

std::string words_of_edge(const TriangleMesh& mesh, uint32_t from, uint32_t to)
{
    return fmt::format("edge {}-{} from {} to {}", from, to, words_of(mesh.positions[from]),
                       words_of(mesh.positions[to]));
}

/// " (the first of 12 such edges)", or nothing if there is only one.
std::string one_of(uint64_t count, const char* what)
{
    return count > 1 ? fmt::format(" (the first of {} such {})", count, what) : "";
}

std::optional<MeshDefect> find_bad_corner(const TriangleMesh& mesh)
{
    uint64_t count = 0;
    std::string found;
    for (size_t face = 0; face < mesh.triangles.size(); ++face) {
        for (const uint32_t vertex : mesh.triangles[face]) {
            if (vertex < mesh.positions.size()) continue;
            if (count++ == 0)
                found =
                    fmt::format("face {} names vertex {}, but there are only {}", face, vertex, mesh.positions.size());
        }
    }
    if (count == 0) return std::nullopt;
    return MeshDefect{Kind::degenerate, found + one_of(count, "corners"), "the file is damaged; export it again"};
}

std::optional<MeshDefect> find_not_finite(const TriangleMesh& mesh)
{
    std::vector<bool> seen(mesh.positions.size(), false);
    uint64_t count = 0;
    std::string found;
    for (size_t face = 0; face < mesh.triangles.size(); ++face) {
        for (const uint32_t vertex : mesh.triangles[face]) {
            const V3d& p = mesh.positions[vertex];
            if (seen[vertex] || (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) continue;
            seen[vertex] = true;
            if (count++ == 0) found = fmt::format("vertex {} of face {} is at {}", vertex, face, words_of(p));
        }
    }
    if (count == 0) return std::nullopt;
    return MeshDefect{Kind::not_finite, found + one_of(count, "vertices"),
                      "--repair drops these faces and closes small holes"};
}

std::optional<MeshDefect> find_degenerate(const TriangleMesh& mesh)
{
    uint64_t count = 0;
    size_t first = 0;
    for (size_t face = 0; face < mesh.triangles.size(); ++face) {
        const auto& [a, b, c] = mesh.triangles[face];
        if (has_area(mesh.positions[a], mesh.positions[b], mesh.positions[c])) continue;
        if (count++ == 0) first = face;
    }
    if (count == 0) return std::nullopt;
    return MeshDefect{Kind::degenerate, words_of_face(mesh, first) + " has no area" + one_of(count, "faces"),
                      repair_hint};
}

/// A face at one of its edges.
struct FaceEdge {
    uint32_t low, high; ///< vertices of the edge
    uint32_t face;
    bool forward; ///< whether the face runs from low to high

    bool same_edge(const FaceEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<FaceEdge> sorted_edges(const TriangleMesh& mesh)
{
    std::vector<FaceEdge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (uint32_t face = 0; face < mesh.triangles.size(); ++face) {
        const auto& triangle = mesh.triangles[face];
        for (size_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
            edges.push_back({low, high, face, triangle[k] == low});
        }
    }
    std::ranges::sort(edges, [](const FaceEdge& a, const FaceEdge& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    return edges;
}

/// Edges without exactly two faces that run along it in opposite directions.
std::optional<MeshDefect> find_bad_edge(const TriangleMesh& mesh, const std::vector<FaceEdge>& edges)
{
    struct Count {
        uint64_t edges = 0;
        size_t first = 0, faces = 0;
        void add(size_t begin, size_t end)
        {
            if (edges++ == 0) first = begin, faces = end - begin;
        }
    } open, crowded, against;
    for (size_t begin = 0; begin < edges.size();) {
        size_t end = begin;
        while (end < edges.size() && edges[end].same_edge(edges[begin])) ++end;
        const size_t faces = end - begin;
        if (faces == 1)
            open.add(begin, end);
        else if (faces > 2)
            crowded.add(begin, end);
        else if (edges[begin].forward == edges[begin + 1].forward)
            against.add(begin, end);
        begin = end;
    }
    const auto words = [&](const Count& c) { return words_of_edge(mesh, edges[c.first].low, edges[c.first].high); };
    if (open.edges > 0) {
        return MeshDefect{
            Kind::open,
            fmt::format("{} has one face, {}{}", words(open), edges[open.first].face, one_of(open.edges, "edges")),
            "--repair joins seams and closes small holes"};
    }
    if (crowded.edges > 0) {
        return MeshDefect{
            Kind::not_manifold,
            fmt::format("{} has {} faces{}", words(crowded), crowded.faces, one_of(crowded.edges, "edges")),
            "--repair separates parts that touch along an edge; walls without thickness must be given a thickness"};
    }
    if (against.edges > 0) {
        return MeshDefect{Kind::not_oriented,
                          fmt::format("{}: faces {} and {} disagree on which side is out{}", words(against),
                                      edges[against.first].face, edges[against.first + 1].face,
                                      one_of(against.edges, "edges")),
                          "--repair turns faces so that they agree"};
    }
    return std::nullopt;
}

/// Vertices at which several fans of faces meet. Every edge must have two faces.
std::optional<MeshDefect> find_bad_vertex(const TriangleMesh& mesh, const std::vector<FaceEdge>& edges)
{
    // At each end of an edge, the corners of its two faces belong to one fan: fans are the components of this graph.
    std::vector<uint64_t> parent(3 * mesh.triangles.size());
    for (uint64_t k = 0; k < parent.size(); ++k) parent[k] = k;
    const auto root = [&](uint64_t k) {
        while (parent[k] != k) {
            parent[k] = parent[parent[k]];
            k = parent[k];
        }
        return k;
    };
    const auto corner = [&](uint32_t face, uint32_t vertex) {
        const auto& t = mesh.triangles[face];
        return 3 * uint64_t{face} + (t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2);
    };
    for (size_t k = 0; k + 1 < edges.size(); k += 2) {
        for (const uint32_t vertex : {edges[k].low, edges[k].high})
            parent[root(corner(edges[k].face, vertex))] = root(corner(edges[k + 1].face, vertex));
    }
    std::vector<uint32_t> fans(mesh.positions.size(), 0);
    for (uint64_t k = 0; k < parent.size(); ++k)
        if (parent[k] == k) ++fans[mesh.triangles[k / 3][k % 3]];
    const auto bad = [](uint32_t n) { return n > 1; };
    const auto first = std::ranges::find_if(fans, bad);
    if (first == fans.end()) return std::nullopt;
    const auto vertex = static_cast<size_t>(first - fans.begin());
    const auto count = static_cast<uint64_t>(std::ranges::count_if(fans, bad));
    return MeshDefect{Kind::not_manifold,
                      fmt::format("vertex {} at {}: {} separate fans of faces meet{}", vertex,
                                  words_of(mesh.positions[vertex]), *first, one_of(count, "vertices")),
                      "--repair gives each fan a vertex of its own"};
}

std::optional<MeshDefect> find_self_intersection(const TriangleMesh& mesh)
{
    constexpr uint64_t enough = 100'000;
    const SelfIntersections found = find_self_intersections(mesh, enough);
    if (found.pairs == 0) return std::nullopt;
    const std::string more = found.pairs > 1 ? fmt::format(" (the first of {}{} such pairs)",
                                                           found.pairs >= enough ? "at least " : "", found.pairs)
                                             : "";
    return MeshDefect{
        Kind::self_intersecting,
        fmt::format("{} meets {}{}", words_of_face(mesh, found.first), words_of_face(mesh, found.second), more),
        "--repair cannot fix this: unite parts that overlap, or remesh the surface through a level set"};
}

} // namespace

std::optional<MeshDefect> find_surface_defect(const TriangleMesh& mesh)
{
    if (mesh.triangles.empty())
        return MeshDefect{Kind::empty, fmt::format("no faces ({} vertices)", mesh.positions.size()), ""};
    if (auto defect = find_bad_corner(mesh)) return defect;
    if (auto defect = find_not_finite(mesh)) return defect;
    if (auto defect = find_degenerate(mesh)) return defect;
    const std::vector<FaceEdge> edges = sorted_edges(mesh);
    if (auto defect = find_bad_edge(mesh, edges)) return defect;
    if (auto defect = find_bad_vertex(mesh, edges)) return defect;
    return find_self_intersection(mesh);
}

std::optional<MeshDefect> describe_inside_out(const TriangleMesh& mesh, const std::vector<uint32_t>& faces)
{
    if (faces.empty()) return std::nullopt;
    return MeshDefect{Kind::inside_out,
                      words_of_face(mesh, faces[0]) + " and its whole shell look into the solid" +
                          one_of(faces.size(), "shells"),
                      "--repair turns shells to look outward"};
}

std::vector<MeshDefect> find_defects(const TriangleMesh& mesh)
{
    if (auto defect = find_surface_defect(mesh)) return {*defect};
    const SurfaceTree tree(mesh);
    if (auto defect = describe_inside_out(mesh, find_inside_out_shells(mesh, find_shells(mesh), tree)))
        return {*defect};
    return {};
}

} // namespace scree
