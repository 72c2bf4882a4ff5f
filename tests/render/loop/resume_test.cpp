// An interrupted render continues to the same bits, and only with the same input.

#include "render/film/checkpoint.h"
#include "render/film/exr_output.h"
#include "render/loop/render_loop.h"
#include "tests/builders/scene_files.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"

#include <gmock/gmock.h>

#include <cstring>

namespace scree {
namespace {

using namespace test;
using testing::HasSubstr;

TEST(PictureResumed, AfterATimeoutIsTheSameAsInOneGo)
{
    const TemporaryFolder folder;
    const std::string scene = standard_scene().write(folder);
    const Picture whole = render_picture(scene, [](RenderJob& job) { job.spp = 12; });
    const auto part = [&](double timeout, bool resume) {
        return render_picture(scene, [&](RenderJob& job) {
            job.spp = 12;
            job.options.timeout = timeout;
            job.resume = resume;
        });
    };
    const std::filesystem::path checkpoint = folder.path("out.exr.checkpoint");
    const Picture first = part(1e-9, false);
    EXPECT_EQ(first.numbers.at("spp"), 1);
    EXPECT_TRUE(std::filesystem::exists(checkpoint));
    const Picture second = part(1e-9, true); // the existing samples count as the first wave
    EXPECT_LT(second.numbers.at("spp"), 12);
    EXPECT_TRUE(std::filesystem::exists(checkpoint));
    const Picture last = part(0, true);
    EXPECT_EQ(last.numbers.at("spp"), 12);
    EXPECT_EQ(difference(last, whole), "");
    EXPECT_FALSE(std::filesystem::exists(checkpoint)) << "a finished picture needs none";
    EXPECT_EQ(difference(part(0, true), whole), "") << "resuming without a checkpoint starts from the beginning";
}

/// An environment map of one bright texel.
void write_sky(const std::filesystem::path& path, double radiance)
{
    Film film(8, 4, 0, 0, 8, 4);
    for (Pixel& pixel : film.pixels()) pixel.add(Color(0.2f), {});
    film.at(3, 1).add(Color(static_cast<float>(radiance)), {});
    write_exr(path, film, {}, {});
}

/// A render that a timeout stopped after its first wave; `found` returns what a resumption finds wrong, or "".
class PictureResumedOnOther : public testing::Test {
protected:
    PictureResumedOnOther()
    {
        files_.orientations = true;
        write_sky(folder_.path("sky.exr"), 1);
        scene_ = folder_.write("sky.json", replace_all(read_bytes(files_.write(folder_)),
                                                       R"({"kind": "constant", "radiance": [0.3, 0.35, 0.4]})",
                                                       R"({"kind": "environment", "file": "sky.exr"})"));
        render_picture(scene_, [](RenderJob& job) {
            job.spp = 12;
            job.options.timeout = 1e-9;
        });
        checkpoint_ = read_bytes(folder_.path("out.exr.checkpoint"));
    }
    std::string found(const std::function<void(RenderJob&)>& change = {}) const
    {
        const auto error = input_error_of([&] {
            render_picture(scene_, [&](RenderJob& job) {
                job.spp = 12;
                job.resume = true;
                if (change) change(job);
            });
        });
        return error ? error->found() : "";
    }

    TemporaryFolder folder_;
    SceneFiles files_ = standard_scene();
    std::string scene_, checkpoint_;
    const std::string other_ = "a checkpoint of another picture";
};

TEST_F(PictureResumedOnOther, NothingIsFine) { EXPECT_EQ(found(), ""); }
TEST_F(PictureResumedOnOther, SeedIsRefused)
{
    EXPECT_THAT(found([](RenderJob& job) { job.options.seed = 1; }), HasSubstr(other_));
}
TEST_F(PictureResumedOnOther, SizeIsRefused)
{
    EXPECT_THAT(found([](RenderJob& job) { job.set("--size", "41x30"); }), HasSubstr(other_));
}
TEST_F(PictureResumedOnOther, CropIsRefused)
{
    EXPECT_THAT(found([](RenderJob& job) { job.crop = {0, 0.5, 0, 1}; }), HasSubstr(other_));
}
TEST_F(PictureResumedOnOther, DepthLimitIsRefused)
{
    EXPECT_THAT(found([](RenderJob& job) { job.set("--max-depth", "3"); }), HasSubstr(other_));
}
TEST_F(PictureResumedOnOther, DirectLightIsRefused)
{
    EXPECT_THAT(found([](RenderJob& job) { job.options.path.direct_light = DirectLight::lights_only; }),
                HasSubstr(other_));
}
TEST_F(PictureResumedOnOther, SceneIsRefused)
{
    EXPECT_THAT(found([](RenderJob& job) { job.overrides = {{"camera.fov", "41", ""}}; }), HasSubstr(other_));
}

TEST_F(PictureResumedOnOther, RadiusIsRefused)
{
    files_.frames[0][3].radius *= 1.01;
    folder_.write("grains.dump", dump_text(files_.frames, true));
    EXPECT_THAT(found(), HasSubstr(other_));
}
TEST_F(PictureResumedOnOther, OrientationIsRefused)
{
    files_.frames[0][6].orientation = Imath::Quatd(0, 1, 0, 0);
    folder_.write("grains.dump", dump_text(files_.frames, true));
    EXPECT_THAT(found(), HasSubstr(other_));
}
TEST_F(PictureResumedOnOther, ShapeIsRefused)
{
    folder_.write("ball.obj", obj_text(icosphere(2)));
    EXPECT_THAT(found(), HasSubstr(other_));
}
TEST_F(PictureResumedOnOther, SurfaceIsRefused)
{
    folder_.write("floor.obj", obj_text(ground(17, -5)));
    EXPECT_THAT(found(), HasSubstr(other_));
}
TEST_F(PictureResumedOnOther, EnvironmentMapIsRefused)
{
    write_sky(folder_.path("sky.exr"), 2);
    EXPECT_THAT(found(), HasSubstr(other_));
}
TEST_F(PictureResumedOnOther, DamagedCheckpointIsRefused)
{
    folder_.write("out.exr.checkpoint", checkpoint_.substr(0, checkpoint_.size() - 1));
    EXPECT_THAT(found(), HasSubstr("ends early"));
    folder_.write("out.exr.checkpoint",
                  "something else entirely, longer than the head of a checkpoint could be, by far");
    EXPECT_THAT(found(), HasSubstr("no checkpoint"));
    folder_.write("out.exr.checkpoint", "");
    EXPECT_THAT(found(), HasSubstr("no checkpoint"));
}

/// A ball of glass among clay, and everything to render it without files.
struct SmallScene {
    SmallScene()
    {
        const uint32_t clay = scene.add_type(lambert(0.7f)), glass = scene.add_type(dielectric(1.5));
        scene.add_grain(V3d(0), 1, glass);
        scene.add_grain(V3d(1.5, 0.8, 0), 0.9, clay);
        scene.add_grain(V3d(-1.7, 0.8, 0), 0.9, clay);
        scene.add_constant_light(1);
        scene.build();
        description.origin = V3d(0, -4, 1);
    }
    RenderStatistics run(Film& film, uint32_t spp, const Progress& progress = {}) const
    {
        RenderOptions options;
        options.spp = spp;
        return render(scene.world(), scene.tracer(), Camera(description, film.width(), film.height()), Filter(), film,
                      options, progress);
    }
    TestScene scene;
    CameraDescription description;
};

bool same_pixels(const Film& a, const Film& b)
{
    return std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size() * sizeof(Pixel)) == 0;
}

TEST(PictureResumed, StoppedInTheMiddleOfAWaveIsTheSameAsInOneGo)
{
    const SmallScene small;
    const TemporaryFolder folder;
    Film whole(70, 50, 0, 0, 70, 50);
    small.run(whole, 9);
    for (const int stop_after : {1, 7, 25, 50}) {
        Film film(70, 50, 0, 0, 70, 50);
        int updates = 0;
        Progress* self = nullptr;
        Progress progress([&](const std::string&, double) {
            if (++updates == stop_after) self->cancel();
        });
        self = &progress;
        const RenderStatistics stopped = small.run(film, 9, progress);
        EXPECT_TRUE(stopped.cancelled);
        EXPECT_LT(stopped.spp, 9u);
        const CheckpointKey key{1, 2};
        write_checkpoint(folder.path("film"), film, key);
        Film again(70, 50, 0, 0, 70, 50);
        read_checkpoint(folder.path("film"), again, key);
        EXPECT_TRUE(same_pixels(film, again));
        const RenderStatistics rest = small.run(again, 9);
        EXPECT_EQ(rest.spp, 9u);
        EXPECT_EQ(stopped.paths + rest.paths, 70u * 50u * 9u) << "no sample is drawn twice";
        EXPECT_TRUE(same_pixels(again, whole)) << "stopped after " << stop_after << " tiles";
    }
}

TEST(PictureResumed, InAnyWavesIsTheSameAsInOneGo)
{
    const SmallScene small;
    Film whole(33, 17, 0, 0, 33, 17), waves(33, 17, 0, 0, 33, 17);
    small.run(whole, 11);
    for (const uint32_t spp : {1, 2, 5, 6, 11}) small.run(waves, spp);
    EXPECT_TRUE(same_pixels(whole, waves));
    small.run(waves, 3); // fewer than there are: nothing to do
    EXPECT_TRUE(same_pixels(whole, waves));
}

} // namespace
} // namespace scree
