// Meshes that bound no solid are either refused with their first defect and its place, or repaired with a list of the
// changes. None of them crashes or stalls the program, TetGen included.

#include "base/error.h"
#include "packing/solids/domain.h"
#include "packing/solids/tetrahedra.h"
#include "tests/builders/shapes.h"
#include "tests/packing/solids.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>

using namespace scree;
using Imath::V3d;
using Kind = MeshDefect::Kind;
using testing::HasSubstr;

namespace {

constexpr double nan_ = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

struct BrokenMesh {
    const char* name;
    TriangleMesh mesh;
    Kind kind;
    const char* found; ///< part of the message: what and where
    double volume = nan_; ///< after repair; NaN: repair cannot make a solid of it
    const char* change = ""; ///< part of what repair says
};

TriangleMesh edited(TriangleMesh mesh, const std::function<void(TriangleMesh&)>& edit)
{
    edit(mesh);
    return mesh;
}

TriangleMesh unit_box() { return box_mesh(V3d(0), V3d(1)); }

/// The same mesh with a separate vertex for each corner of each face.
TriangleMesh exploded(const TriangleMesh& mesh)
{
    TriangleMesh result;
    for (const auto& t : mesh.triangles) {
        const auto n = static_cast<uint32_t>(result.positions.size());
        for (const uint32_t corner : t) result.positions.push_back(mesh.positions[corner]);
        result.triangles.push_back({n, n + 1, n + 2});
    }
    return result;
}

/// Replaces vertex `from` by `to` in every face.
TriangleMesh renamed(TriangleMesh mesh, uint32_t from, uint32_t to)
{
    for (auto& t : mesh.triangles)
        for (uint32_t& corner : t)
            if (corner == from) corner = to;
    return mesh;
}

TriangleMesh moebius_strip()
{
    TriangleMesh mesh;
    const int n = 24;
    for (int k = 0; k < n; ++k) {
        const double phi = 2 * M_PI * k / n;
        for (const double w : {-0.3, 0.3}) {
            const double r = 1 + w * std::cos(phi / 2);
            mesh.positions.emplace_back(r * std::cos(phi), r * std::sin(phi), w * std::sin(phi / 2));
        }
    }
    for (uint32_t k = 0; k < n; ++k) {
        const uint32_t a = 2 * k, b = 2 * k + 1;
        // The last pair of edges is joined to the first with a half turn.
        const bool last = k + 1 == n;
        const uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
        mesh.triangles.push_back({a, c, b});
        mesh.triangles.push_back({b, c, d});
    }
    return mesh;
}

/// Two boxes that share vertices: those of their corners that are at the same place.
TriangleMesh glued(const TriangleMesh& a, const TriangleMesh& b)
{
    TriangleMesh both = joined(a, b);
    for (uint32_t k = static_cast<uint32_t>(a.positions.size()); k < both.positions.size(); ++k)
        for (uint32_t j = 0; j < a.positions.size(); ++j)
            if (both.positions[j] == both.positions[k]) both = renamed(both, k, j);
    return both;
}

std::vector<BrokenMesh> broken_meshes()
{
    const TriangleMesh cube = unit_box();
    const auto moved_vertex = [&](const V3d& to) {
        return edited(cube, [&](TriangleMesh& m) { m.positions[7] = to; });
    };
    std::vector<BrokenMesh> list;
    list.push_back({"no faces", {}, Kind::empty, "no faces (0 vertices)"});
    list.push_back({"vertices alone", edited(cube, [](TriangleMesh& m) { m.triangles.clear(); }), Kind::empty,
                    "no faces (8 vertices)"});
    list.push_back({"missing vertex", edited(cube, [](TriangleMesh& m) { m.triangles[3][1] = 99; }), Kind::degenerate,
                    "face 3 names vertex 99, but there are only 8", 1,
                    "dropped 1 face with a vertex that does not exist"});
    list.push_back({"NaN", moved_vertex({1, nan_, 1}), Kind::not_finite, "vertex 7 of face 2 is at (1, nan, 1)",
                    5.0 / 6, "with a vertex that is not finite"});
    list.push_back({"infinite", moved_vertex({1, 1, inf}), Kind::not_finite, "vertex 7 of face 2 is at (1, 1, inf)",
                    5.0 / 6, "filled a hole of"});
    list.push_back({"all NaN", edited(cube, [](TriangleMesh& m) { std::ranges::fill(m.positions, V3d(nan_)); }),
                    Kind::not_finite, "(the first of 8 such vertices)"});
    list.push_back({"repeated vertex",
                    edited(cube,
                           [](TriangleMesh& m) {
                               m.triangles.push_back({1, 1, 2});
                           }),
                    Kind::degenerate, "face 12 (vertices 1, 1, 2 at (1, 0, 0), (1, 0, 0), (0, 1, 0)) has no area", 1,
                    "dropped 1 face with a repeated vertex"});
    // A corner of the lid is moved to the middle of an edge. One face then has its corners on a line, and another one
    // overlaps nothing.
    list.push_back(
        {"flat face",
         edited(cube,
                [](TriangleMesh& m) {
                    m.positions.emplace_back(0.5, 0, 0);
                    m.triangles[5] = {0, 8, 4}; // of {0, 5, 4} and {0, 1, 5}: the edge 0-1 gets a middle ...
                    m.triangles[4] = {8, 5, 4};
                    m.triangles.push_back({8, 1, 5});
                    m.triangles.push_back({0, 1, 8}); // ... on this side alone, and a face without area between
                }),
         Kind::degenerate, "face 13 (vertices 0, 1, 8 at (0, 0, 0), (1, 0, 0), (0.5, 0, 0)) has no area", 1,
         "without area"});
    list.push_back(
        {"open",
         edited(cube, [](TriangleMesh& m) { m.triangles.erase(m.triangles.begin() + 2, m.triangles.begin() + 4); }),
         Kind::open, "edge 4-5 from (0, 0, 1) to (1, 0, 1) has one face, 3 (the first of 4 such edges)", 1,
         "filled a hole of 4 edges"});
    list.push_back({"single triangle",
                    {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}},
                    Kind::open,
                    "edge 0-1 from (0, 0, 0) to (1, 0, 0) has one face, 0 (the first of 3 such edges)"});
    list.push_back({"seams", exploded(cube), Kind::open, "(the first of 36 such edges)", 1,
                    "merged 28 vertices with others at the same place"});
    list.push_back({"Moebius strip", moebius_strip(), Kind::open, "(the first of 48 such edges)"});
    list.push_back({"face too many",
                    edited(cube,
                           [](TriangleMesh& m) {
                               m.positions.emplace_back(0.5, -1, 2);
                               m.triangles.push_back({4, 8, 5});
                           }),
                    Kind::open, "edge 4-8 from (0, 0, 1) to (0.5, -1, 2) has one face, 12"});
    list.push_back({"cubes at an edge", glued(cube, box_mesh({1, 1, 0}, {2, 2, 1})), Kind::not_manifold,
                    "edge 3-7 from (1, 1, 0) to (1, 1, 1) has 4 faces", 2, "where parts of the surface touch"});
    list.push_back({"cubes at a face", glued(cube, box_mesh({1, 0, 0}, {2, 1, 1})), Kind::not_manifold, "has 4 faces"});
    list.push_back({"cubes at a vertex", glued(cube, box_mesh({1, 1, 1}, {2, 2, 2})), Kind::not_manifold,
                    "vertex 7 at (1, 1, 1): 2 separate fans of faces meet", 2,
                    "doubled 1 vertex where parts of the surface touch"});
    list.push_back({"duplicate face", edited(cube, [](TriangleMesh& m) { m.triangles.push_back(m.triangles[0]); }),
                    Kind::not_manifold, "edge 0-2 from (0, 0, 0) to (0, 1, 0) has 3 faces (the first of 3 such edges)",
                    1, "dropped 1 face that was there already"});
    list.push_back({"all faces twice", joined(cube, cube), Kind::self_intersecting,
                    "face 0 (vertices 0, 2, 3 at (0, 0, 0), (0, 1, 0), (1, 1, 0)) meets face 12", 1,
                    "dropped 12 faces that were there already"});
    list.push_back({"flipped face",
                    edited(cube, [](TriangleMesh& m) { std::swap(m.triangles[3][0], m.triangles[3][1]); }),
                    Kind::not_oriented,
                    "edge 4-6 from (0, 0, 1) to (0, 1, 1): faces 3 and 8 disagree on which side is out (the first of 3 "
                    "such edges)",
                    1, "turned 1 face to agree"});
    list.push_back({"all flipped", flipped(cube), Kind::inside_out, "face 0 (vertices 0, 3, 2", 1,
                    "turned 1 shell that looked into the solid"});
    list.push_back({"cavity looking wrong", joined(icosphere(1), scaled(icosphere(1), 0.5)), Kind::inside_out,
                    "face 80 (", 0.875 * 3.6587, "turned 1 shell that looked into the solid"});
    list.push_back(
        {"island in a cavity looking wrong",
         joined(joined(icosphere(1), flipped(scaled(icosphere(1), 0.5))), flipped(scaled(icosphere(1), 0.25))),
         Kind::inside_out, "face 160 (", (0.875 + 1.0 / 64) * 3.6587, "turned 1 shell that looked into the solid"});
    list.push_back({"crossing spheres", joined(icosphere(2), moved(icosphere(2), {1, 0.1, 0.2})),
                    Kind::self_intersecting, "meets face"});
    list.push_back({"corner through the floor", moved_vertex({0.6, 0.4, -0.5}), Kind::self_intersecting, "meets face"});
    // The corner at (1, 1, 1) is moved past the opposite one at the origin: the solid turns inside out without
    // crossing.
    list.push_back({"corner past the opposite one", moved_vertex({-0.5, -0.5, -0.5}), Kind::inside_out, "face 0 (", 0.5,
                    "turned 1 shell"});
    // All of the lid is folded onto the floor: closed and oriented, but without volume.
    list.push_back({"sheet without thickness",
                    edited(cube,
                           [](TriangleMesh& m) {
                               for (V3d& p : m.positions) p.z = 0;
                           }),
                    Kind::degenerate, "has no area"});
    list.push_back({"two-sided triangle",
                    {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}},
                    Kind::self_intersecting,
                    "face 0 (vertices 0, 1, 2 at (0, 0, 0), (1, 0, 0), (0, 1, 0)) meets face 1"});
    // A tetrahedron flattened to a quadrilateral: faces fold back onto each other.
    list.push_back({"sliver folds",
                    {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}, {1, 3, 2}, {0, 3, 1}}},
                    Kind::self_intersecting,
                    "meets face"});
    list.push_back({"huge and open", edited(scaled(cube, 1e300), [](TriangleMesh& m) { m.triangles.pop_back(); }),
                    Kind::open, "(1e+300, 0, 0)", inf, "filled a hole of 3 edges"});
    list.push_back(
        {"tiny and inside out", flipped(scaled(cube, 1e-300)), Kind::inside_out, "1e-300", 0, "turned 1 shell"});
    return list;
}

class BrokenMeshes : public testing::TestWithParam<BrokenMesh> {
protected:
    void SetUp() override { start_ = std::chrono::steady_clock::now(); }
    void TearDown() override
    {
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start_;
        EXPECT_LT(time.count(), 10) << "seconds";
    }

private:
    std::chrono::steady_clock::time_point start_;
};

} // namespace

TEST_P(BrokenMeshes, FirstDefectIsNamedWithItsPlace)
{
    const BrokenMesh& broken = GetParam();
    const std::vector<MeshDefect> defects = find_defects(broken.mesh);
    ASSERT_EQ(defects.size(), 1u);
    EXPECT_EQ(defects[0].kind, broken.kind) << defects[0].found;
    EXPECT_THAT(defects[0].found, HasSubstr(broken.found));
    try {
        const Domain domain(broken.mesh, "broken.off");
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.place(), "broken.off");
        EXPECT_EQ(error.found(), defects[0].found);
        EXPECT_EQ(error.hint(), defects[0].hint);
    }
}

TEST_P(BrokenMeshes, RepairMakesASolidAndSaysHowOrLeavesADefect)
{
    const BrokenMesh& broken = GetParam();
    std::vector<std::string> changes;
    const TriangleMesh repaired = repair_mesh(broken.mesh, changes);
    const std::vector<MeshDefect> left = find_defects(repaired);
    if (std::isnan(broken.volume)) {
        ASSERT_EQ(left.size(), 1u) << "repaired after all: " << testing::PrintToString(changes);
        EXPECT_FALSE(left[0].found.empty());
        return;
    }
    ASSERT_TRUE(left.empty()) << left[0].found << testing::PrintToString(changes);
    EXPECT_THAT(changes, testing::Contains(HasSubstr(broken.change)));
    const Domain domain(repaired, "repaired");
    if (std::isfinite(broken.volume))
        EXPECT_NEAR(domain.volume(), broken.volume, 1e-4 * broken.volume);
    else
        EXPECT_EQ(domain.volume(), broken.volume);
}

TEST_P(BrokenMeshes, TetGenComesBackWithinItsTime)
{
    TetgenOptions options;
    options.time = std::chrono::seconds(3);
    std::string trouble;
    const Tetrahedra tetrahedra = tetrahedralize(GetParam().mesh, options, trouble);
    EXPECT_EQ(tetrahedra.cells.empty(), !trouble.empty());
}

INSTANTIATE_TEST_SUITE_P(All, BrokenMeshes, testing::ValuesIn(broken_meshes()), [](const auto& test) {
    std::string name = test.param.name;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
});

// Random faces over a few vertices, beyond the list above: everything returns, and every accepted mesh is a solid.
TEST(BrokenMeshesByChance, NothingThrowsAnythingElse)
{
    uint64_t state = 1, solids = 0;
    const auto draw = [&](uint64_t n) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return (state >> 33) % n;
    };
    for (int trial = 0; trial < 300; ++trial) {
        TriangleMesh mesh = unit_box();
        // Makes some wrong corners, some vertices at the place of another, and some missing faces.
        for (uint64_t k = draw(4); k > 0; --k)
            mesh.triangles[draw(mesh.triangles.size())][draw(3)] = static_cast<uint32_t>(draw(9));
        for (uint64_t k = draw(3); k > 0; --k)
            mesh.positions[draw(8)] =
                V3d(static_cast<double>(draw(3)), static_cast<double>(draw(3)), static_cast<double>(draw(3))) * 0.5;
        for (uint64_t k = draw(3); k > 0; --k)
            mesh.triangles.erase(mesh.triangles.begin() + static_cast<int64_t>(draw(mesh.triangles.size())));
        std::vector<std::string> changes;
        const TriangleMesh repaired = repair_mesh(mesh, changes);
        if (!find_defects(repaired).empty()) continue;
        ++solids;
        EXPECT_GT(Domain(repaired, "repaired").volume(), 0) << "trial " << trial;
        EXPECT_EQ(changes.empty(), find_defects(mesh).empty()) << "trial " << trial;
    }
    EXPECT_GT(solids, 30u); // some random meshes must be repairable, or the test shows little
}

TEST(Repair, LeavesASolidAlone)
{
    const TriangleMesh mesh = double_walled_shell(1, 0.1);
    std::vector<std::string> changes;
    const TriangleMesh repaired = repair_mesh(mesh, changes);
    EXPECT_TRUE(changes.empty());
    EXPECT_EQ(repaired.triangles, mesh.triangles);
}

TEST(Repair, LargeHoleDoesNotHoldUp)
{
    // The upper half of a fine torus: two borders of 3,000 edges.
    TriangleMesh mesh = torus(1, 0.3, 3000, 8);
    std::erase_if(mesh.triangles, [&](const auto& t) {
        return mesh.positions[t[0]].z < 0.01 && mesh.positions[t[1]].z < 0.01 && mesh.positions[t[2]].z < 0.01;
    });
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::string> changes;
    repair_mesh(mesh, changes);
    EXPECT_FALSE(changes.empty());
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 30);
}
