// Changes that must not change a picture: threads, crops, scale, place, order of rows, grains of radius 0.

#include "tests/builders/scene_files.h"
#include "tests/builders/shapes.h"
#include "tests/builders/statistics.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace scree {
namespace {

using namespace test;

/// The standard scene's picture, with which most tests compare.
const Picture& standard_picture()
{
    static const Picture picture = [] {
        const TemporaryFolder folder;
        return render_picture(standard_scene().write(folder));
    }();
    return picture;
}

Picture picture_of(const SceneFiles& files, const std::function<void(RenderJob&)>& change = {})
{
    const TemporaryFolder folder;
    return render_picture(files.write(folder), change);
}

TEST(Picture, ShowsGrainsOfEveryTypeAndLight)
{
    const Picture& picture = standard_picture();
    EXPECT_TRUE(picture.all_finite());
    std::vector<int> seen(4, 0);
    for (const uint32_t type : picture.integers.at("type")) {
        if (type < 4) ++seen[type];
    }
    for (const int count : seen) EXPECT_GT(count, 20);
    EXPECT_EQ(picture.numbers.at("nonFiniteSamples"), 0);
    EXPECT_GT(picture.mean("R"), 0.1);
}

TEST(Picture, IsTheSameOnAnyNumberOfThreads)
{
    const TemporaryFolder folder;
    const std::string scene = standard_scene().write(folder);
    for (const int threads : {1, 2, 5}) {
        EXPECT_EQ(difference(render_picture(scene, [&](RenderJob& job) { job.threads = threads; }), standard_picture()),
                  "")
            << threads;
    }
}

TEST(Picture, FollowsTheSeed)
{
    const TemporaryFolder folder;
    const std::string scene = standard_scene().write(folder);
    for (const uint64_t seed : {uint64_t{1}, uint64_t{1} << 32, ~uint64_t{0}}) {
        EXPECT_NE(
            difference(render_picture(scene, [&](RenderJob& job) { job.options.seed = seed; }), standard_picture()), "")
            << seed;
    }
}

TEST(Picture, CropsAbutAndAreTheSameAsTheWhole)
{
    const TemporaryFolder folder;
    const std::string scene = standard_scene().write(folder);
    // Cuts on and between the middles of pixels (0.5125 * 40 = 20.5).
    const double xs[] = {0, 0.31, 0.5125, 1}, ys[] = {0, 0.45, 0.7, 1};
    std::vector<int> covered(40 * 30, 0);
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            const Picture crop = render_picture(scene, [&](RenderJob& job) {
                job.crop = {xs[i], xs[i + 1], ys[j], ys[j + 1]};
            });
            EXPECT_EQ(difference(crop, standard_picture()), "") << i << "," << j;
            EXPECT_EQ(crop.display, standard_picture().data);
            for (int y = crop.data.min.y; y <= crop.data.max.y; ++y) {
                for (int x = crop.data.min.x; x <= crop.data.max.x; ++x) ++covered[static_cast<size_t>(y * 40 + x)];
            }
        }
    }
    EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), 40 * 30);
}

TEST(Picture, PixelBoundsAreTheSameAsTheWholeAndCutAtItsEdge)
{
    const TemporaryFolder folder;
    const std::string scene = standard_scene().write(folder);
    const Picture crop = render_picture(scene, [&](RenderJob& job) { job.pixel_bounds = {-7, 13, 28, 99}; });
    EXPECT_EQ(crop.data, Imath::Box2i({0, 28}, {12, 29}));
    EXPECT_EQ(difference(crop, standard_picture()), "");
}

TEST(Picture, CropOfNoPixelIsAnError)
{
    const TemporaryFolder folder;
    const std::string scene = standard_scene().write(folder);
    const auto error = input_error_of([&] {
        render_picture(scene, [&](RenderJob& job) { job.crop = {0.5, 0.505, 0, 1}; });
    });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->place(), "--cropwindow");
}

class PictureScaled : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(PowersOfTwo, PictureScaled, testing::Values(-60, -20, -1, 3, 20, 60), [](const auto& test) {
    return (test.param < 0 ? "down" : "up") + std::to_string(std::abs(test.param));
});

TEST_P(PictureScaled, IsTheSameToTheBit)
{
    const auto scale = static_cast<float>(std::ldexp(1.0, GetParam()));
    SceneFiles files = standard_scene();
    files.scale = scale;
    EXPECT_EQ(difference(picture_of(files), standard_picture(), scale), "");
}

TEST_P(PictureScaled, IsTheSameWithSurfacesOnly)
{
    const auto scale = static_cast<float>(std::ldexp(1.0, GetParam()));
    const auto write = [](double by, const TemporaryFolder& folder) {
        TriangleMesh box = cube();
        for (V3d& p : box.positions) p *= by;
        folder.write("box.obj", obj_text(box));
        return folder.write(
            "scene.json",
            fmt::format(
                R"({{"camera": {{"kind": "orthographic", "origin": [{0:.17g}, {1:.17g}, {0:.17g}], "target": [0, 0, 0], "width": {0:.17g}}},
            "film": {{"size": [24, 24], "aov": ["depth"]}}, "lights": [{{"kind": "constant"}}],
            "surfaces": [{{"mesh": "box.obj", "material": {{"kind": "dielectric", "ior": 1.3, "roughness": 0.2, "absorption": {2:.17g}}}}}]}})",
                4 * by, -5 * by, 0.5 / by));
    };
    const TemporaryFolder folder, scaled;
    EXPECT_EQ(difference(render_picture(write(scale, scaled)), render_picture(write(1, folder)), scale), "");
}

// Coordinates here are multiples of 2^-20, so that adding 1e7 loses nothing: then nothing may change at all.
TEST(PictureFarAway, IsTheSameToTheBitWhereTheInputIsExact)
{
    SceneFiles files = standard_scene();
    files.offset = V3d(1e7, -1e7, 2e7);
    EXPECT_EQ(difference(picture_of(files), standard_picture()), "");
}

// With arbitrary digits the input itself is rounded to 2^-30 of a unit at 1e7. Paths are chaotic, so a fraction of them
// changes into other samples of the same picture. So the bound on the mean is 4 standard errors of the paired
// difference of the pixels; the standard error must itself be below a thousandth of the mean, and pixels must
// correlate.
TEST(PictureFarAway, IsTheSameWithinTheRoundingOfItsInput)
{
    SceneFiles near = standard_scene();
    for (DumpGrain& g : near.frames[0]) g.center += V3d(0.1 / 3, 0.2 / 7, 0.1 / 9);
    SceneFiles far = near;
    far.offset = V3d(1e7, -1e7, 1e7) + V3d(1) / 3;
    const Picture a = picture_of(near), b = picture_of(far);
    for (const char* channel : {"R", "G", "B"}) {
        const auto &p = a.floats.at(channel), &q = b.floats.at(channel);
        Estimate paired;
        double pp = 0, qq = 0, pq = 0;
        for (size_t i = 0; i < p.size(); ++i) {
            paired.add(static_cast<double>(q[i]) - p[i]);
            const double x = p[i] - a.mean(channel), y = q[i] - b.mean(channel);
            pp += x * x;
            qq += y * y;
            pq += x * y;
        }
        EXPECT_LE(std::abs(paired.mean()), 4 * paired.standard_error() + 0x1p-24 * a.mean(channel)) << channel;
        EXPECT_LT(paired.standard_error(), 1e-3 * a.mean(channel)) << channel;
        EXPECT_GT(pq / std::sqrt(pp * qq), 0.999) << channel;
    }
    size_t other = 0;
    for (size_t i = 0; i < a.integers.at("id").size(); ++i) other += a.integers.at("id")[i] != b.integers.at("id")[i];
    EXPECT_LE(other, 1u);
}

TEST(Picture, DoesNotFollowTheOrderOfRows)
{
    SceneFiles files = standard_scene();
    std::reverse(files.frames[0].begin(), files.frames[0].end());
    std::rotate(files.frames[0].begin(), files.frames[0].begin() + 13, files.frames[0].end());
    EXPECT_EQ(difference(picture_of(files), standard_picture()), "");
}

TEST(Picture, FollowsIdentity)
{
    // The same spheres with other ids: the meshes have other rotations, everything else is the same.
    SceneFiles files = standard_scene();
    for (DumpGrain& g : files.frames[0]) g.id += 1000;
    const Picture picture = picture_of(files);
    EXPECT_NE(picture.floats.at("N.X"), standard_picture().floats.at("N.X"));
}

// --- grains that must do no harm ---

struct Harmless {
    std::string name;
    int type;
};
void PrintTo(const Harmless& h, std::ostream* out) { *out << h.name; }

class PictureWith : public testing::TestWithParam<Harmless> {};
INSTANTIATE_TEST_SUITE_P(Types, PictureWith,
                         testing::Values(Harmless{"glass", 1}, Harmless{"clay", 2}, Harmless{"cube", 3},
                                         Harmless{"gem", 4}),
                         [](const auto& test) { return test.param.name; });

TEST_P(PictureWith, ZeroRadiusIsTheSameAsWithout)
{
    SceneFiles files = standard_scene();
    auto& grains = files.frames[0];
    grains.insert(grains.begin() + 20, DumpGrain{1000, GetParam().type, V3d(0.5, 0.25, 0), 0});
    grains.push_back({1001, GetParam().type, grains[0].center, 0}); // in the middle of a grain
    grains.push_back({1002, GetParam().type, grains[1].center + V3d(grains[1].radius, 0, 0), 0}); // on a grain
    EXPECT_EQ(difference(picture_of(files), standard_picture()), "");
}

TEST_P(PictureWith, ZeroRadiusFarOutsideIsTheSameAsWithout)
{
    SceneFiles files = standard_scene();
    files.frames[0].push_back({1000, GetParam().type, V3d(300, 200, -100), 0});
    EXPECT_EQ(difference(picture_of(files), standard_picture()), "");
}

TEST_P(PictureWith, TinyGrainIsTheSameAsWithout)
{
    SceneFiles files = standard_scene();
    auto& grains = files.frames[0];
    grains.push_back({1000, GetParam().type, V3d(0.5, 0.25, 0), 1e-12});
    grains.push_back({1001, GetParam().type, grains[0].center, 1e-12});
    grains.push_back({1002, GetParam().type, grains[1].center + V3d(grains[1].radius, 0, 0), 1e-12});
    grains.push_back({1003, GetParam().type, grains[2].center + V3d(0, 0, grains[2].radius), 1e-30});
    grains.push_back({1004, GetParam().type, V3d(-1, 0.25, 1), 1e-44}); // subnormal as float
    EXPECT_EQ(difference(picture_of(files), standard_picture()), "");
}

/// Without the id channel: either of two coincident grains may be the visible one.
Picture without_ids(Picture picture)
{
    picture.integers.erase("id");
    return picture;
}

TEST_P(PictureWith, CoincidentGrainsAreTheSameAsOne)
{
    SceneFiles files = standard_scene();
    files.orientations = true; // else the rotations of the two would differ
    const Imath::Quatd turned = Imath::Quatd(0.5, 0.1, -0.7, 0.4).normalized();
    for (DumpGrain& g : files.frames[0]) g.orientation = turned;
    const Picture one = picture_of(files);
    auto& grains = files.frames[0];
    const size_t count = grains.size();
    for (size_t i = 0; i < count; ++i) {
        if (grains[i].type != GetParam().type) continue;
        for (const uint64_t copy : {1000, 2000}) {
            DumpGrain twin = grains[i];
            twin.id += copy;
            grains.push_back(twin);
        }
    }
    const Picture twins = picture_of(files);
    EXPECT_TRUE(twins.all_finite());
    EXPECT_EQ(difference(without_ids(twins), without_ids(one)), "");
}

// One of two coincident grains of different types is visible, and it is the same one everywhere.
TEST(Picture, CoincidentGrainsOfTwoTypesAreOneOfThem)
{
    SceneFiles files = standard_scene();
    files.frames[0] = {{1, 2, V3d(0), 1.0}, {2, 1, V3d(3, 0, 0), 1.0}};
    const Picture clay = picture_of(files);
    files.frames[0] = {{1, 1, V3d(0), 1.0}, {2, 1, V3d(3, 0, 0), 1.0}};
    const Picture glass = picture_of(files);
    for (const int first : {1, 2}) {
        files.frames[0] = {{1, first, V3d(0), 1.0}, {2, 1, V3d(3, 0, 0), 1.0}, {3, 3 - first, V3d(0), 1.0}};
        const Picture both = without_ids(picture_of(files));
        EXPECT_TRUE(both.all_finite());
        const std::string as_clay = difference(both, without_ids(clay)),
                          as_glass = difference(both, without_ids(glass));
        EXPECT_TRUE(as_clay.empty() || as_glass.empty()) << "as clay: " << as_clay << "; as glass: " << as_glass;
    }
}

TEST(Picture, OfNothingButGrainsOfNoSizeIsTheBackground)
{
    SceneFiles files = standard_scene();
    files.floor = false;
    files.frames[0] = {{1, 1, V3d(0), 0}, {2, 3, V3d(0), 0}};
    const Picture picture = picture_of(files);
    EXPECT_TRUE(picture.all_finite());
    for (const uint32_t id : picture.integers.at("id")) EXPECT_EQ(id, no_grain);
}

// --- frames ---

TEST(PictureFrames, GrainKeepsItsRotationWhenItsRowChanges)
{
    const std::vector<DumpGrain> still = {{5, 2, V3d(-2, 0, 0), 1.0}, {7, 3, V3d(0), 1.2}, {9, 4, V3d(2, 0, 0), 1.0}};
    // In the second frame the rows are reversed, and a grain too small to see comes first: all indices move by one.
    const std::vector<DumpGrain> moved = {still[2], still[1], still[0], {1, 3, V3d(1, 0, 0), 1e-12}};
    SceneFiles files = standard_scene();
    files.frames = {still, moved, {{5, 2, V3d(-2, 0, 0), 1.0}, {8, 3, V3d(0), 1.2}, {9, 4, V3d(2, 0, 0), 1.0}}};
    const TemporaryFolder folder;
    const std::string scene = files.write(folder);
    const auto frame = [&](size_t n) {
        return render_picture(scene, [&](RenderJob& job) { job.frames = FrameRange{n, n, 1}; });
    };
    const Picture first = frame(0);
    EXPECT_EQ(difference(frame(1), first), "");
    const Picture other_id = frame(2);
    EXPECT_NE(other_id.floats.at("N.Z"), first.floats.at("N.Z")) << "another id has another rotation";
}

TEST(PictureFrames, ARangeIsTheSameAsFrameByFrame)
{
    SceneFiles files = standard_scene();
    for (int f = 1; f < 5; ++f) {
        files.frames.push_back(files.frames[0]);
        for (DumpGrain& g : files.frames.back()) g.center += V3d(0.2 * f, 0, 0);
    }
    const TemporaryFolder folder;
    const std::string scene = files.write(folder);
    RenderJob job;
    job.scene = scene;
    job.spp = 2;
    job.quiet = true;
    job.frames = FrameRange{0, 4, 2};
    job.outputs = {folder.path("film.exr").string(), folder.path("again_%03d.exr").string()};
    ASSERT_EQ(run_render_job(job), 0);
    for (const size_t n : {0, 2, 4}) {
        const Picture single = render_picture(scene, [&](RenderJob& one) {
            one.frames = FrameRange{n, n, 1};
            one.spp = 2;
        });
        EXPECT_EQ(difference(read_picture(folder.path(fmt::format("film.{:04}.exr", n))), single), "");
        EXPECT_EQ(difference(read_picture(folder.path(fmt::format("again_{:03}.exr", n))), single), "");
        EXPECT_EQ(single.numbers.at("frame"), static_cast<float>(n));
    }
    EXPECT_FALSE(std::filesystem::exists(folder.path("film.0001.exr")));
}

} // namespace
} // namespace scree
