// Measures the evaluations per second of every kind of mixture on one core, through the same virtual call as in the
// renderer, and the time to load explicit types of ten million spheres.
//
//   mixture_bench [SPHERES]

#include "base/hash.h"
#include "base/json.h"
#include "ingest/particles/vdb_points.h"
#include "mixtures/explicit_mixture.h"
#include "mixtures/make_mixture.h"
#include "mixtures/read_mixture.h"
#include "mixtures/type_table.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <numeric>

namespace scree {
namespace {

double seconds(const std::function<void()>& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

ParticleFrame random_spheres(size_t count)
{
    ParticleFrame frame;
    frame.has_ids = true;
    frame.position.resize(count);
    frame.radius.resize(count);
    frame.type.resize(count);
    frame.id.resize(count);
    std::iota(frame.id.begin(), frame.id.end(), uint64_t{1});
    for (size_t i = 0; i < count; ++i) {
        for (unsigned a = 0; a < 3; ++a)
            frame.position[i][static_cast<int>(a)] = 100 * unit_double(hash_index(i, 1, a));
        frame.radius[i] = static_cast<float>(0.1 + unit_double(hash_index(i, 1, 3)));
        frame.type[i] = static_cast<int32_t>(1 + hash_index(i, 1, 4) % 3);
    }
    frame.origin = Imath::V3d(50);
    return frame;
}

void bench_kinds(const ParticleFrame& frame, const std::filesystem::path& folder)
{
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(0);
    grid->setName("c");
    for (int i = 0; i < 64 * 64 * 64; ++i) grid->tree().setValue({i & 63, i >> 6 & 63, i >> 12}, 0.5f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(100.0 / 64));
    openvdb::io::File((folder / "c.vdb").string()).write(openvdb::GridCPtrVec{grid});

    const std::vector<std::pair<const char*, const char*>> mixtures{
        {"single", R"("a")"},
        {"explicit", R"({"kind": "explicit"})"},
        {"random, 2 types", R"({"kind": "random", "types": ["a", "b"], "weights": [0.3, 0.7]})"},
        {"random, 3 types", R"({"kind": "random", "types": ["a", "b", "c"]})"},
        {"random by volume", R"({"kind": "random", "types": ["a", "b"], "by": "volume"})"},
        {"perlin, 1 octave", R"({"kind": "perlin", "types": ["a", "b"], "scale": 7})"},
        {"perlin, 4 octaves", R"({"kind": "perlin", "types": ["a", "b"], "scale": 7, "octaves": 4})"},
        {"checkerboard", R"({"kind": "checkerboard", "types": ["a", "b"], "cell": 7})"},
        {"checkerboard, turned",
         R"({"kind": "checkerboard", "types": ["a", "b"], "cell": 7, "rotation": [10, 20, 30]})"},
        {"checkerboard, 3 types", R"({"kind": "checkerboard", "types": ["a", "b", "c"], "cell": 7})"},
        {"layers", R"({"kind": "layers", "types": ["a", "b", "c"], "thicknesses": [1, 2, 3]})"},
        {"layers, jitter",
         R"({"kind": "layers", "types": ["a", "b"], "thicknesses": 2, "jitter": {"amplitude": 1, "scale": 5}})"},
        {"radius", R"({"kind": "radius", "types": ["a", "b"], "thresholds": [0.5]})"},
        {"grid", R"({"kind": "grid", "fields": [{"type": "a", "file": "c.vdb"}], "rest": "b"})"},
        {"blend", R"({"kind": "blend", "by": {"kind": "checkerboard", "types": ["m", "n"], "cell": 9},
                      "mixtures": {"m": "a", "n": {"kind": "random", "types": ["b", "c"]}}})"},
    };
    const MixtureContext context{{"a", "b", "c"}, {{1, "a"}, {2, "b"}, {3, "c"}}, &frame, false, "bench"};
    std::vector<Imath::V3f> places;
    for (size_t i = 0; i < frame.size(); ++i) places.push_back(frame.relative_position(i));
    fmt::print("{:<24}{:>14}{:>14}\n", "kind", "million/s", "to make, s");
    for (const auto& [name, text] : mixtures) {
        const JsonDocument document = JsonDocument::parse(text, name, folder);
        std::unique_ptr<Mixture> mixture;
        const double making = seconds([&] { mixture = make_mixture(read_mixture(document.root()), context); });
        uint64_t sum = 0;
        double best = 1e300;
        for (int repeat = 0; repeat < 5; ++repeat)
            best = std::min(best, seconds([&] {
                                for (size_t i = 0; i < places.size(); ++i) sum += mixture->type(i, places[i]);
                            }));
        fmt::print("{:<24}{:>14.1f}{:>14.3f}   ({:.3f})\n", name, 1e-6 * static_cast<double>(places.size()) / best,
                   making, static_cast<double>(sum) / static_cast<double>(5 * places.size()));
    }
}

void bench_tables(const ParticleFrame& frame, const std::filesystem::path& folder)
{
    fmt::memory_buffer text;
    fmt::format_to(std::back_inserter(text), "id,type\n");
    for (size_t i = 0; i < frame.size(); ++i) {
        const size_t k = (i * 7919) % frame.size(); // in shuffled order
        fmt::format_to(std::back_inserter(text), "{},{}\n", frame.id[k], frame.type[k]);
    }
    std::ofstream(folder / "types.csv", std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
    write_vdb_points(frame, folder / "types.vdb");

    fmt::print("\nexplicit types of {} spheres\n", frame.size());
    const auto load = [&](const char* file) {
        const double time = seconds([&] {
            mixture_from_table(read_type_table(folder / file), {0, 1, 2}, frame, file);
        });
        fmt::print("{:<24}{:>14.3f} s\n", file, time);
    };
    fmt::print("{:<24}{:>14.3f} s\n", "the dump's own", seconds([&] {
                   mixture_from_frame(frame, {{1, 0}, {2, 1}, {3, 2}}, "dump");
               }));
    load("types.csv");
    load("types.vdb");
}

} // namespace
} // namespace scree

int main(int argc, char** argv)
{
    const size_t count = argc > 1 ? std::stoull(argv[1]) : 10'000'000;
    const auto folder = std::filesystem::temp_directory_path() / "scree_mixture_bench";
    std::filesystem::create_directories(folder);
    scree::bench_kinds(scree::random_spheres(std::min<size_t>(count, 1'000'000)), folder);
    scree::bench_tables(scree::random_spheres(count), folder);
    std::filesystem::remove_all(folder);
}
