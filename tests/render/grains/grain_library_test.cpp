// The grain library: what every shape promises, at several tessellations and for several individuals.

#include "render/grains/library/grain_library.h"

#include "base/hash.h"
#include "ingest/meshes/self_intersections.h"
#include "render/integrators/path_tracer.h"
#include "tests/builders/packings.h"
#include "tests/builders/scenes.h"
#include "tests/builders/statistics.h"
#include "tests/builders/test_files.h"

#include <gmock/gmock.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <set>

namespace scree {
namespace {

using test::input_error_of;
using testing::HasSubstr;

constexpr uint64_t tessellations[] = {20, 1500, 20000};

TriangleMesh shape_of(const LibraryGrain& grain, uint64_t triangles, uint64_t seed = 0)
{
    return make_grain_shape(grain, {seed, triangles, {}}, "test");
}

uint64_t hash_of(const TriangleMesh& mesh)
{
    uint64_t hash = mesh.triangles.size();
    for (const V3d& p : mesh.positions) {
        for (const double x : {p.x, p.y, p.z}) hash = mix64(hash ^ std::bit_cast<uint64_t>(x)) + 1;
    }
    for (const auto& t : mesh.triangles) {
        for (const uint32_t v : t) hash = mix64(hash ^ v) + 1;
    }
    return hash;
}

std::vector<std::string> names_of_library()
{
    std::vector<std::string> names;
    for (const LibraryGrain& grain : grain_library()) names.push_back(grain.name);
    return names;
}

TEST(GrainLibrary, HasTheFourteenTypes)
{
    EXPECT_THAT(names_of_library(),
                testing::UnorderedElementsAre("sugar", "brown_sugar", "ice", "snowflake", "white_sand", "yellow_sand",
                                              "brown_sand", "dark_brown_sand", "black_sand", "flour", "hairball",
                                              "cinnamon", "dielectric_sphere", "diffuse_sphere"));
    for (const LibraryGrain& grain : grain_library()) {
        EXPECT_EQ(find_library_grain(grain.name), &grain);
        EXPECT_FALSE(grain.description.empty());
        EXPECT_GT(grain.typical_radius, 1e-6);
        EXPECT_LT(grain.typical_radius, 1e-2);
        EXPECT_GE(grain.version, 1u);
        EXPECT_EQ(grain.default_triangles == 0, grain.name.ends_with("_sphere"));
        for (const ShapeParameter& p : shape_parameters(grain)) {
            EXPECT_LE(p.least, p.value) << grain.name << " " << p.name;
            EXPECT_LE(p.value, p.most) << grain.name << " " << p.name;
            EXPECT_FALSE(p.what.empty());
        }
    }
    EXPECT_EQ(find_library_grain("granite"), nullptr);
}

class Shape : public testing::TestWithParam<std::string> {
protected:
    const LibraryGrain& grain() const { return *find_library_grain(GetParam()); }
};

TEST_P(Shape, FillsTheUnitSphereWithAboutTheTrianglesAskedFor)
{
    for (const uint64_t triangles : tessellations) {
        for (const uint64_t seed : {0u, 7u}) {
            SCOPED_TRACE(testing::Message() << triangles << " triangles, seed " << seed);
            const TriangleMesh mesh = shape_of(grain(), triangles, seed);
            EXPECT_GE(static_cast<double>(mesh.triangles.size()), 0.8 * static_cast<double>(triangles));
            EXPECT_LE(static_cast<double>(mesh.triangles.size()), 1.2 * static_cast<double>(triangles));
            double farthest = 0;
            for (const V3d& p : mesh.positions) farthest = std::max(farthest, p.length());
            EXPECT_LE(farthest, 1 + 1e-12);
            EXPECT_GE(farthest, 1 - 1e-12);
            for (const auto& t : mesh.triangles) {
                ASSERT_LT(std::max({t[0], t[1], t[2]}), mesh.positions.size());
                // Rounded to float, as in the tracer, every face must still have an area.
                const V3f a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
                ASSERT_GT((b - a).cross(c - a).length(), 0);
            }
        }
    }
}

TEST_P(Shape, IsClosedOutwardAndDoesNotIntersectItself)
{
    const bool may_intersect = GetParam() == "hairball"; // its fibres run through each other, as documented
    for (const uint64_t triangles : tessellations) {
        for (const uint64_t seed : {0u, 7u}) {
            SCOPED_TRACE(testing::Message() << triangles << " triangles, seed " << seed);
            TriangleMesh mesh = shape_of(grain(), triangles, seed);
            EXPECT_TRUE(is_closed_and_oriented(mesh));
            EXPECT_GT(signed_volume(mesh), 0);
            if (may_intersect) continue;
            EXPECT_EQ(find_self_intersections(mesh, 1).pairs, 0u);
            // The mesh rounded to float, as in the tracer, must not intersect itself either.
            for (V3d& p : mesh.positions) p = V3d(V3f(p));
            EXPECT_EQ(find_self_intersections(mesh, 1).pairs, 0u);
        }
    }
}

TEST_P(Shape, IsTheSameEveryTimeAndAnotherForEverySeed)
{
    const TriangleMesh first = shape_of(grain(), 3000, 1);
    EXPECT_EQ(hash_of(first), hash_of(shape_of(grain(), 3000, 1)));
    if (shape_parameters(grain()).empty()) return; // spheres are all alike
    EXPECT_NE(hash_of(first), hash_of(shape_of(grain(), 3000, 2)));
    EXPECT_NE(hash_shape(grain(), {1, 3000, {}}), hash_shape(grain(), {2, 3000, {}}));
}

/// A finer mesh is the same individual, so volumes converge.
TEST_P(Shape, ConvergesWithItsTessellation)
{
    if (GetParam() == "hairball") return; // its number of fibres grows with the triangles
    const double finest = signed_volume(shape_of(grain(), 100000)), fine = signed_volume(shape_of(grain(), 25000));
    EXPECT_NEAR(fine / finest, 1, 0.03);
}

TEST_P(Shape, EveryParameterMakesADifferenceAndItsRangeHolds)
{
    const LibraryGrain& g = grain();
    // Snowflake and hairball have fewer branches and fibres in a coarse mesh; here there are triangles for all of them.
    const uint64_t triangles = GetParam() == "snowflake" || GetParam() == "hairball" ? 60000 : 4000;
    const uint64_t usual = hash_of(shape_of(g, triangles));
    for (const ShapeParameter& p : shape_parameters(g)) {
        for (const double value : {p.least, p.most}) {
            SCOPED_TRACE(p.name + " = " + std::to_string(value));
            const ShapeOptions options{0, triangles, {{p.name, value}}};
            const TriangleMesh mesh = make_grain_shape(g, options, "test");
            EXPECT_TRUE(is_closed_and_oriented(mesh));
            if (g.name != "hairball") {
                EXPECT_EQ(find_self_intersections(mesh, 1).pairs, 0u);
            }
            if (value != p.value) {
                EXPECT_NE(hash_of(mesh), usual);
                EXPECT_NE(hash_shape(g, options), hash_shape(g, {0, triangles, {}}));
            }
        }
        for (const double value : {std::nextafter(p.least, -1e9), std::nextafter(p.most, 1e9), std::nan("")}) {
            const auto error = input_error_of([&] { make_grain_shape(g, {0, 4000, {{p.name, value}}}, "here"); });
            ASSERT_TRUE(error) << p.name << " " << value;
            EXPECT_EQ(error->place(), "here");
            EXPECT_THAT(error->found(), HasSubstr(p.name));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Library, Shape, testing::ValuesIn(names_of_library()),
                         [](const auto& type) { return type.param; });

TEST(GrainLibrary, WrongRequestsAreExplained)
{
    const LibraryGrain& sugar = *find_library_grain("sugar");
    for (const uint64_t triangles : {uint64_t{19}, most_shape_triangles + 1}) {
        const auto error = input_error_of([&] { make_grain_shape(sugar, {0, triangles, {}}, "here"); });
        ASSERT_TRUE(error);
        EXPECT_THAT(error->what(), HasSubstr("20 to 4000000"));
    }
    const auto parameter = input_error_of([&] { make_grain_shape(sugar, {0, 100, {{"roughnes", 0}}}, "here"); });
    ASSERT_TRUE(parameter);
    EXPECT_THAT(parameter->what(), HasSubstr("did you mean 'roughness'?"));
    const auto name = input_error_of([] { require_library_grain("snowflak", "here"); });
    ASSERT_TRUE(name);
    EXPECT_EQ(name->place(), "here");
    EXPECT_THAT(name->hint(), HasSubstr("did you mean 'snowflake'?"));
}

TEST(GrainLibrary, DefaultsAreSpelledOutInTheHash)
{
    const LibraryGrain& sugar = *find_library_grain("sugar");
    const double usual = shape_parameters(sugar)[0].value;
    EXPECT_EQ(hash_shape(sugar, {}),
              hash_shape(sugar, {0, sugar.default_triangles, {{shape_parameters(sugar)[0].name, usual}}}));
    std::set<uint64_t> all;
    for (const LibraryGrain& grain : grain_library()) all.insert(hash_shape(grain, {}));
    EXPECT_EQ(all.size(), grain_library().size());
}

// Shapes must be the same on every machine; otherwise pictures of one scene from several machines would not match.
// The tolerance of volumes only allows for the last bits of sines and powers, which may differ between machines.
TEST(GrainLibrary, ShapesArePinned)
{
    const std::map<std::string, double> volumes{{"sugar", 1.613870639036},
                                                {"brown_sugar", 2.065607669301},
                                                {"ice", 1.744100702781},
                                                {"snowflake", 0.044841955219},
                                                {"white_sand", 1.543591157724},
                                                {"yellow_sand", 2.063965920139},
                                                {"brown_sand", 1.211425584340},
                                                {"dark_brown_sand", 2.060545525172},
                                                {"black_sand", 1.669854641717},
                                                {"flour", 1.991252128976},
                                                {"hairball", 0.021488489598},
                                                {"cinnamon", 0.354562595343},
                                                {"dielectric_sphere", 4.160540155367},
                                                {"diffuse_sphere", 4.160540155367}};
    for (const LibraryGrain& grain : grain_library()) {
        const double volume = signed_volume(shape_of(grain, 2000, 5));
        ASSERT_TRUE(volumes.contains(grain.name));
        EXPECT_NEAR(volume, volumes.at(grain.name), 1e-9)
            << grain.name << ": if you change a generator, raise its version";
    }
}

std::vector<std::string> names_of_dielectrics()
{
    std::vector<std::string> names;
    for (const LibraryGrain& grain : grain_library()) {
        if (grain.material.transmits() && grain.default_triangles > 0) names.push_back(grain.name);
    }
    return names;
}

class LibraryFurnace : public testing::TestWithParam<std::string> {};

// A lossless grain in constant surroundings of radiance 1 is invisible: every path must return exactly 1.
TEST_P(LibraryFurnace, LosslessGrainsAreWhite)
{
    const LibraryGrain& grain = *find_library_grain(GetParam());
    Material lossless = grain.material;
    lossless.absorption = Color(0.0f);
    TestScene scene;
    const uint32_t type = scene.add_type(lossless, shape_of(grain, 5000));
    scene.add_grain(V3d(-0.95, 0, 0), 1, type); // the grains overlap, as in simulations
    scene.add_grain(V3d(0.95, 0, 0.2), 0.95, type);
    scene.add_constant_light(1);
    scene.build();
    constexpr uint32_t paths = 4000;
    std::vector<PathResult> results(paths);
    tbb::parallel_for(uint32_t{0}, paths, [&](uint32_t p) {
        flush_subnormals();
        Sampler sampler(23, p, 0, 0);
        const double z = 2 * sampler.next() - 1, phi = 2 * pi * sampler.next(), r = std::sqrt(1 - z * z);
        const V3d o = 3.0 * V3d(r * std::cos(phi), r * std::sin(phi), z);
        const V3d target(1.6 * sampler.next() - 0.8, sampler.next() - 0.5, sampler.next() - 0.5);
        results[p] = trace_path(scene.world(), scene.tracer(), o, (target - o).normalized(), sampler);
    });
    Estimate radiance;
    uint64_t segments = 0, leaks = 0;
    for (const PathResult& path : results) {
        radiance.add(path.radiance.x);
        segments += path.segments;
        leaks += path.leaks;
    }
    EXPECT_LT(std::abs(radiance.z(1)), 4) << radiance.mean() << " +- " << radiance.standard_error();
    EXPECT_NEAR(radiance.mean(), 1, 0.001);
    EXPECT_GT(segments, 3 * paths / 2) << "hardly any path hit a grain";
    EXPECT_LT(static_cast<double>(leaks), 1e-4 * static_cast<double>(segments));
}

INSTANTIATE_TEST_SUITE_P(Library, LibraryFurnace, testing::ValuesIn(names_of_dielectrics()),
                         [](const auto& type) { return type.param; });

} // namespace
} // namespace scree
