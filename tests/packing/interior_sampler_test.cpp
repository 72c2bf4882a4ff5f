#include "packing/solids/interior_sampler.h"

#include "base/worker_process.h"
#include "packing/solids/tetrahedra.h"
#include "tests/builders/shapes.h"
#include "tests/builders/statistics.h"
#include "tests/packing/solids.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <unistd.h>

using namespace scree;
using Imath::V3d;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

/// A program in a file of its own, which is removed at the end.
class Script {
public:
    explicit Script(const std::string& text)
        : path_(std::filesystem::temp_directory_path() /
                fmt::format("scree_worker_{}_{}", getpid(), reinterpret_cast<uintptr_t>(this)))
    {
        if (text.empty()) return;
        std::ofstream(path_) << text;
        std::filesystem::permissions(path_, std::filesystem::perms::owner_all);
    }
    ~Script() { std::filesystem::remove(path_); }
    Script(const Script&) = delete;
    Script& operator=(const Script&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

double six_volumes(const Tetrahedra& t, size_t k)
{
    const V3d& a = t.points[t.cells[k][0]];
    return std::abs(
        (t.points[t.cells[k][1]] - a).dot((t.points[t.cells[k][2]] - a).cross(t.points[t.cells[k][3]] - a)));
}

/// Volume, first and second moments of a solid, from signed tetrahedra between the origin and its faces: exact for
/// polyhedra, and independent of the sampler.
struct Moments {
    double volume = 0;
    V3d first{0}, second{0}; ///< of x, y, z and of their squares, divided by the volume
};

Moments moments_of(const TriangleMesh& mesh)
{
    Moments m;
    for (const auto& [i, j, k] : mesh.triangles) {
        const V3d &a = mesh.positions[i], &b = mesh.positions[j], &c = mesh.positions[k];
        const double v = a.dot(b.cross(c)) / 6;
        m.volume += v;
        m.first += (a + b + c) * (v / 4);
        // Over a tetrahedron with a corner at the origin: (a^2 + b^2 + c^2 + ab + bc + ca) / 10.
        m.second += (a * a + b * b + c * c + a * b + b * c + c * a) * (v / 10);
    }
    m.first /= m.volume;
    m.second /= m.volume;
    return m;
}

const uint64_t sample_count = 100'000;

/// Mean places and squares are those of the solid: |z| < 4.5 for each of 6 values (chance of a false alarm: 4e-5 for
/// all six together).
void expect_moments(const InteriorSampler& sampler, const TriangleMesh& mesh)
{
    const Moments truth = moments_of(mesh);
    for (int axis = 0; axis < 3; ++axis) {
        Estimate first, second;
        for (uint64_t k = 0; k < sample_count; ++k) {
            const double x = sampler.sample(k, 11)[axis];
            first.add(x);
            second.add(x * x);
        }
        EXPECT_LT(std::abs(first.z(truth.first[axis])), 4.5)
            << "axis " << axis << ": " << first.mean() << " +- " << first.standard_error();
        EXPECT_LT(std::abs(second.z(truth.second[axis])), 4.5)
            << "axis " << axis << ": " << second.mean() << " +- " << second.standard_error();
    }
}

/// The number of points in each lattice cell that lies wholly inside matches the cell's share of the volume
/// (chi-square).
void expect_uniform(const InteriorSampler& sampler, const Domain& domain, int cells)
{
    const auto& [lo, hi] = domain.bounds();
    const V3d edge = (hi - lo) / cells;
    std::vector<double> observed(static_cast<size_t>(cells * cells * cells), 0);
    for (uint64_t k = 0; k < sample_count; ++k) {
        const V3d at = (sampler.sample(k, 12) - lo) / edge;
        const auto index = [&](double x) { return std::clamp(static_cast<int>(x), 0, cells - 1); };
        ++observed[static_cast<size_t>((index(at.x) * cells + index(at.y)) * cells + index(at.z))];
    }
    std::vector<double> whole, expected;
    double rest = static_cast<double>(sample_count);
    for (size_t k = 0; k < observed.size(); ++k) {
        const auto n = static_cast<size_t>(cells);
        const V3d middle = lo + edge * (V3d(static_cast<double>(k / (n * n)), static_cast<double>(k / n % n),
                                            static_cast<double>(k % n)) +
                                        V3d(0.5));
        if (!domain.contains_sphere(middle, edge.length() / 2)) continue;
        whole.push_back(observed[k]);
        expected.push_back(static_cast<double>(sample_count) * edge.x * edge.y * edge.z / domain.volume());
        rest -= observed[k];
    }
    ASSERT_GT(whole.size(), 30u);
    whole.push_back(rest);
    double sum = 0;
    for (const double e : expected) sum += e;
    expected.push_back(static_cast<double>(sample_count) - sum);
    const ChiSquare test = chi_square(whole, expected);
    EXPECT_GT(test.p_value, 1e-4) << test.text;
}

void expect_all_inside(const InteriorSampler& sampler, const Domain& domain)
{
    const double rounding = 1e-14 * domain.bounds().size().length();
    for (uint64_t k = 0; k < 5000; ++k) {
        const V3d p = sampler.sample(k, 13);
        ASSERT_TRUE(domain.contains(p) || domain.distance(p) <= rounding) << p;
    }
}

const std::vector<std::pair<std::string, TriangleMesh>>& solids()
{
    static const std::vector<std::pair<std::string, TriangleMesh>> list = {
        {"box", box_mesh({-1, 2, 3}, {4, 5, 7})},
        {"sphere", icosphere(3)},
        {"torus", torus(1, 0.4, 40, 24)},
        {"hollow cube", joined(box_mesh(V3d(-1), V3d(1)), flipped(box_mesh(V3d(-0.5), V3d(0.75))))},
        {"shell with a ball in it", joined(double_walled_shell(2, 0.2), scaled(icosphere(2), 0.5))},
        {"thin shell", double_walled_shell(3, 0.003)},
        {"two pieces", joined(icosphere(1), moved(icosphere(2), {3, 0, 0}))},
        {"pieces that touch at a corner", joined(box_mesh(V3d(0), V3d(1)), box_mesh(V3d(1), V3d(2)))},
        {"bored cube", bored_cube(20)},
        {"far from the origin", moved(icosphere(2), {1e6, -1e5, 1e4})},
    };
    return list;
}

} // namespace

TEST(InteriorSampler, VolumeIsThatOfTheDivergenceTheorem)
{
    if (!SCREE_TETGEN) GTEST_SKIP() << "built without TetGen";
    for (const auto& [name, mesh] : solids()) {
        const Domain domain(mesh, name);
        const InteriorSampler sampler(domain);
        EXPECT_TRUE(sampler.by_tetgen()) << name << ": " << sampler.method();
        EXPECT_THAT(sampler.method(), StartsWith("TetGen, "));
        EXPECT_NEAR(sampler.volume() / domain.volume(), 1, 1e-12) << name;
        expect_all_inside(sampler, domain);
    }
}

TEST(InteriorSampler, PointsAreUniform)
{
    if (!SCREE_TETGEN) GTEST_SKIP() << "built without TetGen";
    for (const char* name : {"box", "torus", "hollow cube", "shell with a ball in it", "bored cube"}) {
        SCOPED_TRACE(name);
        const TriangleMesh& mesh = std::ranges::find(solids(), name, [](const auto& s) { return s.first; })->second;
        const Domain domain(mesh, name);
        const InteriorSampler sampler(domain);
        ASSERT_TRUE(sampler.by_tetgen());
        expect_moments(sampler, mesh);
        expect_uniform(sampler, domain, 16);
    }
}

TEST(InteriorSampler, PointsAreAFunctionOfIndexAndSeed)
{
    const Domain domain(torus(1, 0.4, 20, 12), "torus");
    const InteriorSampler one(domain), other(domain);
    std::vector<V3d> points(5000);
    tbb::parallel_for(size_t{0}, points.size(), [&](size_t k) { points[k] = one.sample(k, 1); });
    uint64_t same = 0;
    for (size_t k = 0; k < points.size(); ++k) {
        EXPECT_EQ(points[k], other.sample(k, 1));
        same += points[k] == one.sample(k, 2);
    }
    EXPECT_EQ(same, 0u);
}

TEST(InteriorSampler, AnyScaleWillDo)
{
    if (!SCREE_TETGEN) GTEST_SKIP() << "built without TetGen";
    for (const double scale : {0x1p-900, 0x1p-60, 0x1p60, 0x1p900}) {
        const TriangleMesh mesh = scaled(double_walled_shell(1, 0.3), scale);
        const Domain domain(mesh, "shell");
        const InteriorSampler sampler(domain);
        EXPECT_TRUE(sampler.by_tetgen()) << sampler.method();
        expect_all_inside(sampler, domain);
    }
}

// A script replaces TetGen below, and fails in each way a program can fail.
struct Failure {
    const char* script;
    const char* method;
};

class FailingTetGen : public testing::TestWithParam<Failure> {};

TEST_P(FailingTetGen, FallsBackAndSaysWhy)
{
    const Script program(GetParam().script);
    TetgenOptions options;
    options.program = program.path();
    const TriangleMesh mesh = joined(box_mesh(V3d(-1), V3d(1)), flipped(box_mesh(V3d(-0.5), V3d(0.75))));
    const Domain domain(mesh, "hollow cube");
    const InteriorSampler sampler(domain, options);
    EXPECT_FALSE(sampler.by_tetgen());
    EXPECT_THAT(sampler.method(), HasSubstr(GetParam().method));
    EXPECT_EQ(sampler.volume(), domain.volume());
    expect_all_inside(sampler, domain);
}

TEST(WithoutTetGen, PointsAreUniformToo)
{
    TetgenOptions options;
    options.program = "/nonexistent";
    for (const TriangleMesh& mesh :
         {joined(box_mesh(V3d(-1), V3d(1)), flipped(box_mesh(V3d(-0.5), V3d(0.75)))), torus(1, 0.4, 24, 16)}) {
        const Domain domain(mesh, "solid");
        const InteriorSampler sampler(domain, options);
        ASSERT_FALSE(sampler.by_tetgen());
        expect_moments(sampler, mesh);
        expect_uniform(sampler, domain, 16);
    }
}

INSTANTIATE_TEST_SUITE_P(Ways, FailingTetGen,
                         testing::Values(Failure{"", "without TetGen: there is no /"},
                                         Failure{"#!/bin/sh\nexit 0\n", "its answer makes no sense"},
                                         Failure{"#!/bin/sh\nexit 103\n", "it found faces that intersect"},
                                         Failure{"#!/bin/sh\nkill -SEGV $$\n", "signal 11"},
                                         Failure{"#!/bin/sh\nhead -c 100000 /dev/urandom\n",
                                                 "its answer makes no sense"},
                                         Failure{"no program", "it could not be started"},
                                         Failure{"#!/bin/sh\ncat\n", "its answer makes no sense"}));

TEST(WorkerProcess, IsKilledWhenItTakesTooLong)
{
    const std::vector<char> input(10'000'000, 'x'); // more than any pipe buffer holds
    for (const char* script :
         {"sleep 100", "exec 0<&- 1>&-; sleep 100", "while :; do :; done", "cat > /dev/null; sleep 100"}) {
        const auto start = std::chrono::steady_clock::now();
        const WorkerResult result = run_worker("/bin/sh", {"-c", script}, input, std::chrono::milliseconds(300), 1000);
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        EXPECT_FALSE(result.finished) << script;
        EXPECT_EQ(result.trouble, "it took too long") << script;
        EXPECT_LT(time.count(), 5) << script;
    }
}

TEST(WorkerProcess, IsKilledWhenItWritesTooMuch)
{
    const WorkerResult result = run_worker("/bin/sh", {"-c", "cat /dev/zero"}, {}, std::chrono::seconds(20), 1'000'000);
    EXPECT_EQ(result.trouble, "it wrote too much");
    EXPECT_LE(result.output.size(), 1'000'000u);
}

TEST(WorkerProcess, ReadsAndWritesMuch)
{
    std::vector<char> input(5'000'000);
    for (size_t k = 0; k < input.size(); ++k) input[k] = static_cast<char>(k * k >> 7);
    const WorkerResult result = run_worker("/bin/cat", {}, input, std::chrono::seconds(20), 10'000'000);
    EXPECT_TRUE(result.finished) << result.trouble;
    EXPECT_EQ(result.output, input);
}

TEST(Tetrahedralize, FillsCavitiesAsRegionsOfTheirOwn)
{
    if (!SCREE_TETGEN) GTEST_SKIP() << "built without TetGen";
    const TriangleMesh mesh = double_walled_shell(2, 0.25);
    std::string trouble;
    const Tetrahedra all = tetrahedralize(mesh, TetgenOptions{}, trouble);
    ASSERT_EQ(trouble, "");
    const double ball = Domain(icosphere(2), "ball").volume();
    std::map<int32_t, double> volume;
    for (size_t k = 0; k < all.cells.size(); ++k) volume[all.region[k]] += six_volumes(all, k) / 6;
    std::vector<double> volumes;
    for (const auto& [region, v] : volume) volumes.push_back(v / ball);
    const double cavity = std::pow(0.75, 3);
    EXPECT_THAT(volumes, testing::UnorderedElementsAre(testing::DoubleNear(cavity, 1e-12),
                                                       testing::DoubleNear(1 - cavity, 1e-12)));
}

// Passes surfaces to TetGen directly that the checks would reject.
TEST(Tetrahedralize, HostileSurfacesDoNoHarm)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<TriangleMesh> hostile = {joined(icosphere(4), moved(icosphere(4), {0.1, 0.2, 0.3})),
                                         joined(icosphere(3), icosphere(3)), torus(1, 1.5, 60, 40)};
    TriangleMesh mesh = icosphere(3);
    for (size_t k = 0; k < mesh.positions.size(); k += 7) mesh.positions[k].y = nan;
    hostile.push_back(mesh);
    mesh = icosphere(3);
    for (size_t k = 0; k < mesh.positions.size(); ++k)
        mesh.positions[k] = mesh.positions[k * k % mesh.positions.size()];
    hostile.push_back(mesh);
    mesh = icosphere(3);
    for (V3d& p : mesh.positions) p.z *= 1e-17;
    hostile.push_back(mesh);
    mesh = icosphere(3);
    mesh.triangles[100][2] = 1'000'000;
    hostile.push_back(mesh);
    hostile.push_back({});
    for (size_t k = 0; k < hostile.size(); ++k) {
        TetgenOptions options;
        options.time = std::chrono::seconds(4);
        const auto start = std::chrono::steady_clock::now();
        std::string trouble;
        const Tetrahedra all = tetrahedralize(hostile[k], options, trouble);
        EXPECT_EQ(all.cells.empty(), !trouble.empty()) << k;
        EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 8) << k;
    }
}
