#include "render/grains/library/dendrite.h"
#include "render/grains/library/edge_split.h"
#include "render/grains/library/shape_generator.h"

#include <unordered_set>

namespace scree {

namespace {

uint64_t directed(uint32_t a, uint32_t b) { return (static_cast<uint64_t>(a) << 32) | b; }

/// The edges of an oriented mesh that have only one face, in the direction of that face.
std::vector<std::array<uint32_t, 2>> border_of(const TriangleMesh& mesh)
{
    std::unordered_set<uint64_t> edges;
    for (const auto& t : mesh.triangles) {
        for (size_t i = 0; i < 3; ++i) edges.insert(directed(t[i], t[(i + 1) % 3]));
    }
    std::vector<std::array<uint32_t, 2>> border;
    for (const auto& t : mesh.triangles) {
        for (size_t i = 0; i < 3; ++i) {
            if (!edges.contains(directed(t[(i + 1) % 3], t[i]))) border.push_back({t[i], t[(i + 1) % 3]});
        }
    }
    return border;
}

uint64_t triangles_of_solid(const TriangleMesh& sheet)
{
    return 2 * (sheet.triangles.size() + border_of(sheet).size());
}

/// The sheet, its mirror image below z = 0 and the walls between them. They make a solid, because the sheet lies above
/// z = 0 everywhere.
TriangleMesh solid_of(const TriangleMesh& sheet)
{
    TriangleMesh solid = sheet;
    const auto n = static_cast<uint32_t>(sheet.positions.size());
    for (const V3d& p : sheet.positions) solid.positions.emplace_back(p.x, p.y, -p.z);
    for (const auto& t : sheet.triangles) solid.triangles.push_back({t[0] + n, t[2] + n, t[1] + n});
    for (const auto& [a, b] : border_of(sheet)) {
        solid.triangles.push_back({b, a, a + n});
        solid.triangles.push_back({b, a + n, b + n});
    }
    return solid;
}

/// The plain hexagonal plate, 20 triangles as a solid; used if there are not enough triangles for arms.
TriangleMesh hexagon()
{
    TriangleMesh mesh;
    constexpr double h = 0.86602540378443865;
    mesh.positions = {V3d(1, 0, 0), V3d(0.5, h, 0), V3d(-0.5, h, 0), V3d(-1, 0, 0), V3d(-0.5, -h, 0), V3d(0.5, -h, 0)};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    return mesh;
}

} // namespace

TriangleMesh make_snowflake(const ShapeRequest& request)
{
    DendriteOptions options;
    options.plate = request["plate"];
    options.width = request["arm_width"];
    options.branch_length = request["branch_length"];
    const int branches = static_cast<int>(request["branches"]), twigs = static_cast<int>(request["twigs"]);

    // Take the most branched figure for which there are enough triangles.
    TriangleMesh sheet = hexagon();
    uint64_t outline = 6;
    for (int level = branches + twigs; level >= 0; --level) {
        options.branches = std::min(level, branches);
        options.twigs = level - options.branches;
        ShapeRandom random(request.seed, 0x736e6f);
        const Dendrite figure = make_dendrite(options, random);
        TriangleMesh mesh = triangulate(figure);
        if (triangles_of_solid(mesh) > request.triangles) continue;
        sheet = std::move(mesh);
        outline = figure.outline.size();
        break;
    }
    const double half = 0.5 * request["thickness"];
    for (size_t i = 0; i < sheet.positions.size(); ++i)
        sheet.positions[i].z = i < outline ? half : half * (1 + request["ridge"]);

    // Each split adds two triangles to the sheet, or one triangle and one border edge: four to the solid in either
    // case.
    const uint64_t now = triangles_of_solid(sheet);
    split_longest_edges(sheet, request.triangles > now ? (request.triangles - now) / 4 : 0,
                        [](const V3d& middle) { return middle; });
    return solid_of(sheet);
}

} // namespace scree
