// The contents of picture files: channels, windows, metadata, auxiliary values against values computed by hand,
// variance and filters; files appear whole or not at all.

#include "base/error.h"
#include "base/sampler.h"
#include "render/film/checkpoint.h"
#include "render/film/exr_output.h"
#include "tests/builders/scene_files.h"
#include "tests/builders/shapes.h"
#include "tests/builders/statistics.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <sys/resource.h>

#include <csignal>
#include <set>

namespace scree {
namespace {

using namespace test;
using testing::HasSubstr;

// --- filters ---

struct FilterCase {
    Filter filter;
    double second_moment; ///< of one coordinate
    double reach; ///< largest coordinate
};

TEST(Filter, HasItsMoments)
{
    // A gaussian cut at 3 sigma: u = r^2 / (2 sigma^2) is exponential cut at 4.5, and E[x^2] = sigma^2 E[u].
    const double kept = 1 - 4.5 * std::exp(-4.5) / (1 - std::exp(-4.5));
    const FilterCase cases[] = {{{FilterKind::box, 0.5}, 0.25 / 3, 0.5},
                                {{FilterKind::box, 2}, 4.0 / 3, 2},
                                {{FilterKind::tent, 1}, 1.0 / 6, 1},
                                {{FilterKind::tent, 1.7}, 1.7 * 1.7 / 6, 1.7},
                                {{FilterKind::gaussian, 1.5}, 0.25 * kept, 1.5},
                                {{FilterKind::gaussian, 3}, kept, 3}};
    for (const FilterCase& c : cases) {
        Estimate x, y, xx, yy, xy;
        Sampler sampler(1, 0, 0, 0);
        for (int i = 0; i < 200000; ++i) {
            const double u1 = sampler.next(), u2 = sampler.next();
            const V2d p = c.filter.sample(u1, u2);
            ASSERT_LE(std::max(std::abs(p.x), std::abs(p.y)), c.reach * (1 + 1e-12));
            x.add(p.x);
            y.add(p.y);
            xx.add(p.x * p.x);
            yy.add(p.y * p.y);
            xy.add(p.x * p.y);
        }
        SCOPED_TRACE(fmt::format("kind {} radius {}", static_cast<int>(c.filter.kind), c.filter.radius));
        EXPECT_LT(std::abs(x.z(0)), 4);
        EXPECT_LT(std::abs(y.z(0)), 4);
        EXPECT_LT(std::abs(xy.z(0)), 4);
        EXPECT_LT(std::abs(xx.z(c.second_moment)), 4) << xx.mean() << " and not " << c.second_moment;
        EXPECT_LT(std::abs(yy.z(c.second_moment)), 4) << yy.mean() << " and not " << c.second_moment;
    }
}

// --- the sums of a pixel ---

TEST(Pixel, KeepsMeanVarianceAndWhatItSaw)
{
    Pixel pixel;
    EXPECT_EQ(pixel.mean(), Color(0.0f));
    EXPECT_EQ(pixel.variance(), Color(0.0f));
    FirstHit hit;
    hit.hit = true;
    hit.albedo = Color(0.5f);
    hit.depth = 3;
    hit.type = 2;
    hit.id = 77;
    pixel.add(Color(1, 2, 3), hit);
    EXPECT_EQ(pixel.variance(), Color(0.0f)) << "one sample says nothing of variance";
    pixel.add(Color(3, 2, 6), {});
    EXPECT_EQ(pixel.mean(), Color(2, 2, 4.5f));
    // Samples 1 and 3: variance 2 of one, 1 of the mean of two.
    EXPECT_EQ(pixel.variance(), Color(1, 0, 2.25f));
    EXPECT_EQ(pixel.samples, 2u);
    EXPECT_EQ(pixel.hits, 1u);
    EXPECT_EQ(pixel.type, 2u);
    EXPECT_EQ(pixel.id, 77u);
}

// --- files ---

Film noise_film(int width, int height)
{
    Film film(width, height, 0, 0, width, height);
    Sampler sampler(3, 0, 0, 0);
    for (Pixel& pixel : film.pixels()) {
        FirstHit hit;
        hit.hit = true;
        hit.depth = sampler.next();
        pixel.add(Color(static_cast<float>(sampler.next()), static_cast<float>(sampler.next()),
                        static_cast<float>(sampler.next())),
                  hit);
        pixel.add(Color(static_cast<float>(sampler.next())), hit);
    }
    return film;
}

std::set<std::string> channel_names(const Picture& picture)
{
    std::set<std::string> names;
    for (const auto& channel : picture.floats) names.insert(channel.first);
    for (const auto& channel : picture.integers) names.insert(channel.first + " (integer)");
    return names;
}

TEST(ExrFile, HasTheChannelsAskedFor)
{
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path("a.exr");
    const std::vector<std::pair<std::vector<Aov>, std::set<std::string>>> cases{
        {{}, {}},
        {{Aov::albedo}, {"albedo.R", "albedo.G", "albedo.B"}},
        {{Aov::normal}, {"N.X", "N.Y", "N.Z"}},
        {{Aov::depth}, {"Z"}},
        {{Aov::type, Aov::id, Aov::samples}, {"type (integer)", "id (integer)", "samples (integer)"}},
        {{Aov::variance}, {"variance.R", "variance.G", "variance.B"}}};
    for (const auto& [aov, names] : cases) {
        write_exr(path, noise_film(3, 2), aov, {});
        std::set<std::string> expected = names;
        expected.insert({"R", "G", "B"});
        EXPECT_EQ(channel_names(read_picture(path)), expected);
    }
}

TEST(ExrFile, HasThePixelsOfTheFilm)
{
    const TemporaryFolder folder;
    Film film(100, 50, 20, 10, 31, 17); // a part of a picture
    Sampler sampler(4, 0, 0, 0);
    for (Pixel& pixel : film.pixels()) pixel.add(Color(static_cast<float>(sampler.next()), 1e-30f, 3e38f), {});
    write_exr(folder.path("a.exr"), film, {Aov::samples, Aov::id}, {});
    const Picture picture = read_picture(folder.path("a.exr"));
    EXPECT_EQ(picture.display, Imath::Box2i({0, 0}, {99, 49}));
    EXPECT_EQ(picture.data, Imath::Box2i({20, 10}, {30, 16}));
    for (int y = 10; y < 17; ++y) {
        for (int x = 20; x < 31; ++x) {
            const size_t i = picture.index(x, y);
            ASSERT_EQ(picture.floats.at("R")[i], film.at(x, y).mean().x);
            ASSERT_EQ(picture.floats.at("G")[i], 1e-30f) << "floats, not halves";
            ASSERT_EQ(picture.floats.at("B")[i], 3e38f);
            ASSERT_EQ(picture.integers.at("samples")[i], 1u);
            ASSERT_EQ(picture.integers.at("id")[i], 4294967295u);
        }
    }
}

// A full disk: the write fails half way. The old picture stays and nothing lies beside it.
TEST(PictureFile, AppearsWholeOrNotAtAll)
{
    const TemporaryFolder folder;
    const Film film = noise_film(100, 100);
    const std::vector<std::pair<std::string, std::function<void(const std::filesystem::path&)>>> writers{
        {"a.exr", [&](const auto& path) { write_exr(path, film, {Aov::depth}, {}); }},
        {"a.png", [&](const auto& path) { write_preview(path, film); }},
        {"a.jpg", [&](const auto& path) { write_preview(path, film); }},
        {"a.checkpoint", [&](const auto& path) { write_checkpoint(path, film, {}); }}};
    for (const auto& [name, write] : writers) {
        SCOPED_TRACE(name);
        const std::filesystem::path path = folder.path(name);
        folder.write(name, "the old one");
        rlimit before{};
        getrlimit(RLIMIT_FSIZE, &before);
        rlimit small = before;
        small.rlim_cur = 1000;
        const auto handler = std::signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &small);
        const auto error = input_error_of([&, &writer = write] { writer(path); });
        setrlimit(RLIMIT_FSIZE, &before);
        std::signal(SIGXFSZ, handler);
        EXPECT_TRUE(error) << "a write that failed went unnoticed";
        EXPECT_THAT(error ? error->place() : "", HasSubstr(name));
        EXPECT_EQ(read_bytes(path), "the old one");
        EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1)
            << "something lies beside it";
        write(path);
        EXPECT_NE(read_bytes(path), "the old one");
        std::filesystem::remove(path);

        EXPECT_TRUE(input_error_of([&, &writer = write] { writer(folder.path("none") / name); })) << "no such folder";
        EXPECT_TRUE(input_error_of([&, &writer = write] { writer("/proc/" + name); }))
            << "a folder that cannot be written";
        std::filesystem::create_directory(path);
        EXPECT_TRUE(input_error_of([&, &writer = write] { writer(path); })) << "a folder in its place";
        std::filesystem::remove(path);
    }
}

// --- auxiliary channels by hand ---

const std::string all_aovs = R"("aov": ["albedo", "normal", "depth", "type", "id", "variance", "samples"])";
/// A filter so narrow that every sample goes through the middle of its pixel.
const std::string pinpoint = R"("filter": {"kind": "box", "radius": 1e-9})";

TEST(Aov, OfSpheresAreAsByHand)
{
    const TemporaryFolder folder;
    folder.write("grains.dump", dump_text({{{4000000000, 7, V3d(0, 0, 0), 1.0},
                                            {12, 5, V3d(1.5, 3, 0.5), 0.75},
                                            {13, 6, V3d(-1.5, 1, -1.25), 0.5}}},
                                          false));
    const std::string scene = folder.write(
        "scene.json", R"({"camera": {"kind": "orthographic", "origin": [0, -10, 0], "target": [0, 0, 0], "width": 5},
        "film": {"size": [51, 41], )" +
                          pinpoint + ", " + all_aovs + R"(}, "lights": [{"kind": "constant"}],
        "grains": {"types": {"clay": {"shape": "sphere", "material": {"kind": "lambert", "reflectance": [0.25, 0.5, 0.75]}},
                             "glass": {"shape": "sphere", "material": {"kind": "dielectric", "tint": [0.5, 0.75, 1]}},
                             "steel": {"shape": "sphere", "material": {"kind": "conductor", "eta": 1, "k": 4, "tint": 0.25}}},
                   "assembly": {"dump": "grains.dump", "types": {"7": "clay", "5": "glass", "6": "steel"}}}})");
    const Picture picture = render_picture(scene, [](RenderJob& job) { job.spp = 3; });
    EXPECT_EQ(picture.texts.at("grainTypes"), "0=clay,1=glass,2=steel");

    struct Sphere {
        V3d c;
        double r;
        uint32_t type, id;
        Color albedo;
    };
    const Sphere spheres[] = {{V3d(0), 1, 0, 4000000000u, Color(0.25f, 0.5f, 0.75f)},
                              {V3d(1.5, 3, 0.5), 0.75, 1, 12, Color(0.5f, 0.75f, 1)},
                              {V3d(-1.5, 1, -1.25), 0.5, 2, 13, Color(0.25f)}};
    int seen[4] = {};
    for (int y = 0; y < 41; ++y) {
        for (int x = 0; x < 51; ++x) {
            const double px = 2.5 * (2 * (x + 0.5) / 51 - 1), pz = 2.5 * 41 / 51 * (1 - 2 * (y + 0.5) / 41);
            const Sphere* met = nullptr;
            double depth = 0;
            bool edge = false;
            for (const Sphere& s : spheres) {
                const double h2 = s.r * s.r - (px - s.c.x) * (px - s.c.x) - (pz - s.c.z) * (pz - s.c.z);
                edge |= std::abs(h2) < 1e-4;
                if (h2 <= 0 || (met && 10 + s.c.y - std::sqrt(h2) > depth)) continue;
                met = &s;
                depth = 10 + s.c.y - std::sqrt(h2);
            }
            if (edge) continue;
            const size_t i = picture.index(x, y);
            const auto value = [&](const char* channel) { return picture.floats.at(channel)[i]; };
            ASSERT_EQ(picture.integers.at("samples")[i], 3u);
            ++seen[met ? met->type : 3];
            ASSERT_EQ(picture.integers.at("type")[i], met ? met->type : no_grain) << x << "," << y;
            ASSERT_EQ(picture.integers.at("id")[i], met ? met->id : no_grain);
            const Color albedo = met ? met->albedo : Color(0.0f);
            ASSERT_EQ(Color(value("albedo.R"), value("albedo.G"), value("albedo.B")), albedo);
            ASSERT_NEAR(value("Z"), depth, 1e-5);
            const V3d normal = met ? (V3d(px, depth - 10, pz) - met->c) / met->r : V3d(0);
            ASSERT_NEAR(value("N.X"), normal.x, 1e-4);
            ASSERT_NEAR(value("N.Y"), normal.y, 1e-4);
            ASSERT_NEAR(value("N.Z"), normal.z, 1e-4);
            if (!met) {
                ASSERT_EQ(value("R"), 1) << "the constant light itself";
                ASSERT_EQ(value("variance.R"), 0);
                continue;
            }
            // The matrices lead from the point back to the pixel.
            Imath::V3f ndc, seen_from;
            picture.matrices.at("worldToNDC").multVecMatrix(Imath::V3f(V3d(px, depth - 10, pz)), ndc);
            ASSERT_NEAR((ndc.x + 1) / 2 * 51, x + 0.5, 1e-4);
            ASSERT_NEAR((1 - ndc.y) / 2 * 41, y + 0.5, 1e-4);
            picture.matrices.at("worldToCamera").multVecMatrix(Imath::V3f(V3d(px, depth - 10, pz)), seen_from);
            ASSERT_NEAR(-seen_from.z, depth, 1e-4);
            ASSERT_NEAR(seen_from.x, px, 1e-4);
        }
    }
    for (const int count : seen) EXPECT_GT(count, 30);
}

// Depth is along the view, not along the ray: for a wall square to the view it is the same everywhere, also with a
// lens.
TEST(Aov, DepthIsAlongTheView)
{
    const TemporaryFolder folder;
    TriangleMesh wall;
    const V3d view = V3d(1, 2, -0.5).normalized(), across = view.cross(V3d(0, 0, 1)).normalized(),
              up = across.cross(view), middle = V3d(100, -50, 7) + 5.0 * view;
    wall.positions = {middle - 20.0 * across - 20.0 * up, middle + 20.0 * across - 20.0 * up,
                      middle + 20.0 * across + 20.0 * up, middle - 20.0 * across + 20.0 * up};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}};
    folder.write("wall.obj", obj_text(wall));
    for (const double aperture : {0.0, 0.8}) {
        const std::string scene = folder.write(
            "scene.json",
            fmt::format(
                R"({{"camera": {{"origin": [100, -50, 7], "target": [101, -48, 6.5], "fov": 70, "aperture": {}, "focus": 3}},
            "film": {{"size": [16, 12], {}}}, "lights": [{{"kind": "constant"}}],
            "surfaces": [{{"mesh": "wall.obj", "material": {{"kind": "lambert", "reflectance": [0.1, 0.2, 0.3]}}}}]}})",
                aperture, all_aovs));
        const Picture picture = render_picture(scene);
        for (size_t i = 0; i < 16 * 12; ++i) {
            ASSERT_NEAR(picture.floats.at("Z")[i], 5, 2e-5);
            ASSERT_NEAR(picture.floats.at("N.X")[i], -view.x, 1e-6);
            ASSERT_NEAR(picture.floats.at("N.Z")[i], -view.z, 1e-6);
            ASSERT_NEAR(picture.floats.at("albedo.G")[i], 0.2f, 1e-7);
            ASSERT_EQ(picture.integers.at("id")[i], no_grain);
            ASSERT_EQ(picture.integers.at("type")[i], no_grain);
        }
        if (aperture > 0) continue;
        // The perspective matrix leads back to the pixel: the middle of the wall is the middle of the picture.
        Imath::V3f ndc, camera;
        picture.matrices.at("worldToNDC").multVecMatrix(Imath::V3f(middle + 1.1 * across + 0.7 * up), ndc);
        const double half = std::tan(35 * pi / 180);
        EXPECT_NEAR(ndc.x, 1.1 / 5 / (half * 16 / 12), 1e-4);
        EXPECT_NEAR(ndc.y, 0.7 / 5 / half, 1e-4);
        picture.matrices.at("worldToCamera").multVecMatrix(Imath::V3f(middle + 1.1 * across + 0.7 * up), camera);
        EXPECT_LT((camera - Imath::V3f(1.1f, 0.7f, -5)).length(), 1e-4);
    }
}

// At the edge of a grain, depth and normal are means over the samples that hit it, and albedo over all samples.
TEST(Aov, AreMeansOverSamples)
{
    const TemporaryFolder folder;
    const std::string scene = folder.write(
        "scene.json", R"({"camera": {"kind": "orthographic", "origin": [0, -10, 0], "target": [0, 0, 0], "width": 4},
        "film": {"size": [1, 1], "filter": "box", )" +
                          all_aovs + R"(}, "lights": [{"kind": "constant", "radiance": 2}],
        "grains": {"types": {"clay": {"shape": "sphere", "material": {"kind": "lambert", "reflectance": 1}}}, "assembly": {"spheres": [{"center": [0, 0, 0], "radius": 1}]}}})");
    const Picture picture = render_picture(scene, [](RenderJob& job) { job.spp = 40000; });
    // The picture is 4 x 4 and the sphere's disc pi: hit with probability p; the mean depth of hits is 10 - 2/3.
    const double p = pi / 16, se = std::sqrt(p * (1 - p) / 40000);
    EXPECT_NEAR(picture.floats.at("albedo.R")[0], p, 4 * se);
    EXPECT_NEAR(picture.floats.at("Z")[0], 10 - 2.0 / 3, 4 * std::sqrt(1.0 / 18 / (p * 40000)));
    EXPECT_NEAR(picture.floats.at("N.Y")[0], -2.0 / 3, 4 * std::sqrt(1.0 / 18 / (p * 40000)));
    EXPECT_NEAR(picture.floats.at("R")[0], 2, 1e-6) << "a white grain in a constant surrounding";
    EXPECT_EQ(picture.integers.at("samples")[0], 40000u);
}

// The variance channel is the variance of the pixel's mean: its expectation is the variance of the means over seeds.
TEST(Aov, VarianceIsThatOverSeeds)
{
    const TemporaryFolder folder;
    SceneFiles files = standard_scene();
    files.film = R"({"size": [20, 15], "aov": ["variance"]})";
    const std::string scene = files.write(folder);
    constexpr int seeds = 64;
    std::vector<Estimate> mean(20 * 15), told(20 * 15);
    for (int seed = 0; seed < seeds; ++seed) {
        const Picture picture = render_picture(scene, [&](RenderJob& job) {
            job.options.seed = static_cast<uint64_t>(seed);
            job.spp = 8;
        });
        for (size_t i = 0; i < mean.size(); ++i) {
            mean[i].add(picture.floats.at("G")[i]);
            told[i].add(picture.floats.at("variance.G")[i]);
        }
    }
    Estimate difference_of, scatter;
    for (size_t i = 0; i < mean.size(); ++i) {
        const double variance = mean[i].standard_error() * mean[i].standard_error() * seeds;
        difference_of.add(variance - told[i].mean());
        scatter.add(variance);
    }
    std::printf("variance over seeds %.3e, told %.3e less +- %.1e\n", scatter.mean(), difference_of.mean(),
                difference_of.standard_error());
    EXPECT_LT(std::abs(difference_of.z(0)), 4);
    EXPECT_LT(difference_of.standard_error(), 0.15 * scatter.mean());
}

TEST(Metadata, SaysHowThePictureCameToBe)
{
    const TemporaryFolder folder;
    const std::string scene = standard_scene().write(folder);
    const auto make = [&](uint64_t seed) {
        return render_picture(scene, [&](RenderJob& job) {
            job.spp = 3;
            job.options.seed = seed;
        });
    };
    const Picture picture = make(42);
    EXPECT_EQ(picture.texts.at("software"), "Scree");
    EXPECT_EQ(picture.texts.at("version"), SCREE_VERSION);
    EXPECT_EQ(picture.texts.at("integrator"), "ept");
    EXPECT_EQ(picture.texts.at("seed"), "42");
    EXPECT_THAT(picture.texts.at("particles"), HasSubstr("grains.dump"));
    EXPECT_EQ(picture.texts.at("grainTypes"), "0=clay,1=cube,2=gem,3=glass");
    EXPECT_EQ(picture.texts.at("sceneHash").size(), 16u);
    EXPECT_EQ(picture.numbers.at("spp"), 3);
    EXPECT_EQ(picture.numbers.at("frame"), 0);
    EXPECT_EQ(picture.numbers.at("nonFiniteSamples"), 0);
    EXPECT_GT(picture.numbers.at("renderTime"), 0);
    EXPECT_EQ(picture.matrices.count("worldToCamera"), 1u);
    EXPECT_EQ(picture.matrices.count("worldToNDC"), 1u);
    // The hash follows the scene and its files, not the seed.
    EXPECT_EQ(make(43).texts.at("sceneHash"), picture.texts.at("sceneHash"));
    const std::string floor = read_bytes(folder.path("floor.obj"));
    folder.write("floor.obj", obj_text(ground(3, -5)));
    EXPECT_NE(make(42).texts.at("sceneHash"), picture.texts.at("sceneHash"));
    folder.write("floor.obj", floor);
    EXPECT_EQ(make(42).texts.at("sceneHash"), picture.texts.at("sceneHash"));
}

} // namespace
} // namespace scree
