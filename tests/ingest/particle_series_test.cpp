#include "ingest/particles/particle_series.h"

#include "base/error.h"
#include "ingest/particles/vdb_points.h"
#include "tests/builders/test_files.h"

#include <gmock/gmock.h>

namespace scree {
namespace {

using test::TemporaryFolder;

ParticleFrame frame_of(size_t count, int64_t step)
{
    ParticleFrame frame;
    for (size_t i = 0; i < count; ++i) {
        frame.id.push_back(i + 1);
        frame.position.push_back({double(i), 0, 0});
        frame.radius.push_back(0.5f);
        frame.type.push_back(1);
    }
    frame.has_ids = true;
    frame.step = step;
    return frame;
}

const std::string dump = "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n"
                         "ITEM: ATOMS id type x y z radius\n1 1 0.5 0.5 0.5 0.25\n";

TEST(ParticleSeries, FormatIsToldByContentAndNotByName)
{
    const TemporaryFolder folder;
    write_vdb_points(frame_of(3, 5), folder.path("points.dump"));
    const OpenedParticles points = open_particles(folder.path("points.dump").string());
    EXPECT_STREQ(points.format->name, "vdb");
    EXPECT_EQ(points.series->read(0).size(), 3u);
    EXPECT_EQ(points.series->step(0), 5);

    const OpenedParticles text = open_particles(folder.write("text.vdb", dump));
    EXPECT_STREQ(text.format->name, "lammps");
    EXPECT_EQ(text.series->step(0), 7);
}

TEST(ParticleSeries, FilesOfPointsAreAFilm)
{
    const TemporaryFolder folder;
    for (const int64_t k : {2, 10})
        write_vdb_points(frame_of(size_t(k), k), folder.path("p." + std::to_string(k) + ".vdb"));
    const OpenedParticles film = open_particles(folder.path("p.*.vdb").string());
    ASSERT_EQ(film.series->frame_count(), 2u);
    EXPECT_EQ(film.series->read(0).step, 2);
    EXPECT_EQ(film.series->read(1).size(), 10u);
    EXPECT_TRUE(film.series->has_radius(1));
}

TEST(ParticleSeries, FrameThatIsNotThereIsRefused)
{
    const TemporaryFolder folder;
    write_vdb_points(frame_of(1, 0), folder.path("a.vdb"));
    for (const std::string& file : {folder.path("a.vdb").string(), folder.write("a.dump", dump)}) {
        const OpenedParticles one = open_particles(file);
        EXPECT_THROW(one.series->read(1), InputError) << file;
        EXPECT_THROW(one.series->step(1), InputError) << file;
        EXPECT_THROW(one.series->columns(1), InputError) << file;
        EXPECT_THROW(one.series->has_radius(1), InputError) << file;
    }
    EXPECT_THROW(open_particles(folder.path("none.*").string()), InputError);
}

TEST(ParticleSeries, EveryFormatRecognisesOnlyItsOwn)
{
    const TemporaryFolder folder;
    write_vdb_points(frame_of(1, 0), folder.path("a.vdb"));
    const std::vector<std::string> starts{test::read_bytes(folder.path("a.vdb")).substr(0, 100), dump};
    for (const std::string& start : starts) {
        int claims = 0;
        for (const ParticleFormat& format : particle_formats()) claims += format.recognises(start);
        EXPECT_EQ(claims, 1);
    }
    for (const ParticleFormat& format : particle_formats()) EXPECT_FALSE(format.recognises("")) << format.name;
}

} // namespace
} // namespace scree
