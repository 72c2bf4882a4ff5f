// Media as a user meets them: scenes with media, `--grain-depth`, `--integrator vpt` and `scree info --medium`, by the
// built program.

#include "tests/builders/scene_files.h"
#include "tests/builders/scree_process.h"
#include "tests/builders/shapes.h"
#include "tests/render/app/cached_command.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

#include <fstream>

namespace scree {
namespace {

using namespace test;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class MediumCommand : public CachedCommand {
protected:
    MediumCommand() { write("slab.obj", obj_text(box_mesh({-4, -4, -1}, {4, 4, 0}))); }

    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_.path(name)) << text; }
    /// Writes a scene looking at the origin under a white sky, with these additional keys.
    std::string scene(const std::string& keys) const
    {
        write("scene.json",
              R"({"camera": {"origin": [0, -9, 5], "target": [0, 0, 0]}, "film": {"size": [16, 12], "filter": "box"},
            "lights": [{"kind": "constant", "radiance": 1}], )" +
                  keys + "}");
        return path("scene.json");
    }
    /// 729 grey spheres of radius 1/4 on a lattice.
    static std::string grains(float reflectance)
    {
        std::string list;
        for (int i = 0; i < 729; ++i) {
            list += (i ? ", " : "") + std::string(R"({"center": [)") + std::to_string(0.5 * (i % 9 - 4)) + ", " +
                    std::to_string(0.5 * (i / 9 % 9 - 4)) + ", " + std::to_string(0.5 * (i / 81 - 4)) +
                    R"(], "radius": 0.25})";
        }
        return R"("grains": {"types": {"chalk": {"shape": "sphere", "material": {"kind": "lambert", "reflectance": )" +
               std::to_string(reflectance) + R"(}}}, "assembly": {"spheres": [)" + list + "]}}";
    }
    ProgramRun render(const std::string& keys, std::vector<std::string> more = {}) const
    {
        std::vector<std::string> arguments{"render", scene(keys), "-o",         path("out.exr"),
                                           "--spp",  "4",         "--accuracy", "draft"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_scree(arguments);
    }
    json info(const std::string& keys) const
    {
        const ProgramRun run = run_scree({"info", "--medium", scene(keys), "--json"});
        EXPECT_EQ(run.status, 0) << run.err;
        return run.status == 0 ? json::parse(run.out) : json();
    }
};

TEST_F(MediumCommand, TellsAMediumInTheUnitOfTheScene)
{
    const json media =
        info(R"("medium": [{"mesh": "slab.obj", "sigma_t": [1, 2, 4], "albedo": 0.75, "g": 0.5}])")["media"];
    ASSERT_EQ(media.size(), 1u);
    EXPECT_EQ(media[0]["name"], "slab.obj");
    EXPECT_EQ(media[0]["sigma_t"], (json{1, 2, 4}));
    EXPECT_EQ(media[0]["mean_free_path"], (json{1, 0.5, 0.25}));
    EXPECT_EQ(media[0]["transport_mean_free_path"], (json{2, 1, 0.5}));
    EXPECT_EQ(media[0]["albedo"], 0.75);
    EXPECT_EQ(media[0]["g"], 0.5);
    const ProgramRun text = run_scree({"info", "--medium", path("scene.json")});
    EXPECT_THAT(text.out, HasSubstr("transport mean free path   2 1 0.5"));
    EXPECT_THAT(run_scree({"info"}).err, HasSubstr("FILE or --medium SCENE"));
    EXPECT_THAT(run_scree({"info", path("slab.obj"), "--medium", path("scene.json")}).out, HasSubstr("obj mesh"));
}

TEST_F(MediumCommand, TellsTheMediumOfGrains)
{
    const json found = info(grains(0.8f))["grains"];
    EXPECT_NEAR(found["mean_radius"].get<double>(), 0.25, 1e-6);
    EXPECT_NEAR(found["pack_rate"].get<double>(), pi / 6, 0.02);
    const double f = found["pack_rate"];
    EXPECT_NEAR(found["void_flight"].get<double>(), 4 * (1 - f) * 0.25 / (3 * f), 1e-3);
    EXPECT_NEAR(found["grain_g"].get<double>(), -4.0 / 9, 0.01);
    EXPECT_NEAR(found["grain_albedo"].get<double>(), 0.8, 0.01);
    for (const char* form : {"plain", "formula", "walk", "decay"})
        EXPECT_GT(found["forms"][form]["sigma_t"].get<double>(), 0) << form;
}

TEST_F(MediumCommand, RendersMediaAndGrainsAsMedia)
{
    const std::string white = grains(1);
    for (const std::vector<std::string>& how :
         {std::vector<std::string>{"--integrator", "vpt"},
          {"--integrator", "ppt", "--grain-depth", "3"},
          {"--integrator", "ept", "--grain-depth", "3", "--medium-form", "plain"}}) {
        const ProgramRun run =
            render(white + R"(, "medium": [{"mesh": "slab.obj", "sigma_t": [0.5, 1, 2], "albedo": 1}])", how);
        ASSERT_EQ(run.status, 0) << run.err;
        const Picture picture = read_picture(path("out.exr"));
        for (const char* channel : {"R", "G", "B"})
            EXPECT_NEAR(picture.mean(channel), 1, channel[0] == 'G' ? 0.05 : 0.3)
                << how[1]; // nothing is lost; spectral MIS is noisy
        EXPECT_EQ(picture.texts.at("integrator"), how[1]);
        EXPECT_EQ(picture.texts.at("mediumForm"), how.size() > 4 ? "plain" : "decay");
    }
    const ProgramRun plan = render(white, {"--integrator", "ppt", "--grain-depth", "3", "--plan"});
    EXPECT_THAT(plan.out, HasSubstr("medium of the grains"));
    EXPECT_THAT(plan.out, HasSubstr("3 mean radii"));
    EXPECT_THAT(render(white, {"--integrator", "ppt", "--plan"}).out,
                HasSubstr("the integrator traces grains everywhere"));
    EXPECT_THAT(render(R"("medium": [])", {"--plan"}).out, HasSubstr("skipped  medium "));
    const ProgramRun thin = render(white, {"--integrator", "ppt", "--grain-depth", "100", "--stats"});
    EXPECT_EQ(thin.status, 0);
    EXPECT_THAT(thin.out, HasSubstr("no place is 100 mean radii deep"));
}

TEST_F(MediumCommand, ReadsGrids)
{
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(0);
    grid->setName("density");
    grid->fill(openvdb::CoordBBox({-5, -5, -5}, {5, 5, 5}), 1.0f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.2));
    openvdb::io::File(path("cloud.vdb")).write({grid});
    const std::string cloud = R"("medium": [{"vdb": "cloud.vdb", "scale": 5, "albedo": 1, "g": 0.5}])";
    const ProgramRun run = render(cloud);
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(read_picture(path("out.exr")).mean("G"), 1);
    EXPECT_NEAR(info(cloud)["media"][0]["largest_sigma_t"].get<double>(), 5, 1e-5);
    EXPECT_THAT(render(cloud, {"--plan"}).out, HasSubstr("to be read"));
    const ProgramRun wrong = render(R"("medium": [{"vdb": "cloud.vdb", "density": "densty"}])");
    EXPECT_EQ(wrong.status, 2);
    EXPECT_THAT(wrong.err, HasSubstr("did you mean 'density'"));
}

TEST_F(MediumCommand, RefusesWhatIsNoMedium)
{
    write("open.obj", obj_text(ground(1, 0)));
    const ProgramRun open = render(R"("medium": [{"mesh": "open.obj", "sigma_t": 1}])");
    EXPECT_EQ(open.status, 2);
    EXPECT_THAT(open.err, HasSubstr("as a medium is inside it"));
    const std::string coloured = R"({"mesh": "slab.obj", "sigma_t": [1, 2, 3]})";
    const ProgramRun both = render(R"("medium": [)" + coloured + ", " + coloured + "]");
    EXPECT_EQ(both.status, 2);
    EXPECT_THAT(both.err, HasSubstr("depends on the channel"));
    EXPECT_EQ(render(R"("medium": [{"vdb": "none.vdb"}])").status, 2);
    EXPECT_FALSE(std::filesystem::exists(path("out.exr")));
}

} // namespace
} // namespace scree
