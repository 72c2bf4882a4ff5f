// Measures how fast a dump is read, compared with counting its lines: `dump_bench [MEGABYTES]`.
//
// Writes dumps to the temporary folder, reads each on one core (from the page cache), and prints MB of text per second
// of processor time. "open" finds the frames, "read" parses one.

#include "base/byte_source.h"
#include "ingest/particles/dump_series.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace {

using scree::ByteSource;
using scree::DumpSeries;

struct Case {
    const char* name;
    bool wide; ///< velocities and forces too
    bool shuffled; ///< rows in random order, as LAMMPS leaves them
    bool packed;
};

void write_dump(const std::filesystem::path& path, const Case& what, size_t bytes)
{
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> place(0, 1);
    std::normal_distribution<double> speed(0, 1e-3);
    const size_t line_bytes = what.wide ? 118 : 40;
    const size_t count = bytes / line_bytes;
    std::vector<uint64_t> ids(count);
    for (size_t i = 0; i < count; ++i) ids[i] = i + 1;
    if (what.shuffled) std::shuffle(ids.begin(), ids.end(), random);

    fmt::memory_buffer text;
    fmt::format_to(std::back_inserter(text),
                   "ITEM: TIMESTEP\n1000\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS pp pp ff\n0 1\n0 1\n0 1\nITEM: "
                   "ATOMS id type x y z {}radius\n",
                   count, what.wide ? "vx vy vz fx fy fz " : "");
    const std::string mode = what.packed ? "wb1" : "wbT"; // zlib's "T": not compressed
    gzFile file = gzopen(path.c_str(), mode.c_str());
    if (!file) throw std::runtime_error("cannot write " + path.string());
    for (const uint64_t id : ids) {
        fmt::format_to(std::back_inserter(text), "{} {} {:.6g} {:.6g} {:.6g} ", id, 1 + id % 3, place(random),
                       place(random), place(random));
        if (what.wide)
            for (int k = 0; k < 6; ++k) fmt::format_to(std::back_inserter(text), "{:.6g} ", speed(random));
        fmt::format_to(std::back_inserter(text), "{:.4g}\n", 0.001 * (1 + place(random)));
        if (text.size() > (size_t{1} << 22)) {
            gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
            text.clear();
        }
    }
    gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
    gzclose(file);
}

/// Counts the lines and bytes of a file, which is read through ByteSource as DumpSeries does.
std::pair<uint64_t, uint64_t> count_lines(const std::filesystem::path& path)
{
    ByteSource source(path);
    std::vector<char> buffer(size_t{1} << 22);
    uint64_t lines = 0, bytes = 0;
    while (const size_t got = source.read(buffer.data(), buffer.size())) {
        bytes += got;
        const char* p = buffer.data();
        const char* const end = p + got;
        while ((p = static_cast<const char*>(std::memchr(p, '\n', static_cast<size_t>(end - p))))) {
            ++lines;
            if (++p == end) break;
        }
    }
    return {lines, bytes};
}

/// The least processor time of three runs, in seconds; the time of other programs does not count.
double time_of(const std::function<void()>& work)
{
    double best = 1e30;
    for (int i = 0; i < 3; ++i) {
        const std::clock_t start = std::clock();
        work();
        best = std::min(best, double(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return best;
}

void measure(const Case& what, size_t bytes)
{
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / fmt::format("scree_dump_bench_{}.dump", ::getpid());
    struct Remove {
        const std::filesystem::path& path;
        ~Remove() { std::filesystem::remove(path); }
    } remove{path};
    write_dump(path, what, bytes);

    std::pair<uint64_t, uint64_t> counted;
    const double count_time = time_of([&] { counted = count_lines(path); });
    const double open_time = time_of([&] { DumpSeries::open(path.string()); });
    size_t particles = 0;
    const double whole_time = time_of([&] { particles = DumpSeries::open(path.string()).read(0).size(); });
    const DumpSeries series = DumpSeries::open(path.string());
    const double read_time = time_of([&] { particles = series.read(0).size(); });

    const double megabytes = double(counted.second) * 1e-6;
    fmt::print("{:<28} {:>6.0f} MB {:>9} grains | count lines {:>6.0f} MB/s | open {:>6.0f} | read {:>6.0f} | "
               "open+read {:>6.0f} | read takes {:.1f}x, open+read {:.1f}x the count\n",
               what.name, megabytes, particles, megabytes / count_time, megabytes / open_time, megabytes / read_time,
               megabytes / whole_time, read_time / count_time, whole_time / count_time);
}

} // namespace

int main(int argc, char** argv)
{
    try {
        const size_t megabytes = argc > 1 ? std::stoul(argv[1]) : 200;
        const tbb::global_control one_core(tbb::global_control::max_allowed_parallelism, 1);
        for (const Case& what :
             {Case{"id type x y z radius", false, false, false}, Case{"the same, shuffled", false, true, false},
              Case{"with velocity and force", true, false, false}, Case{"the first, gzip", false, false, true}})
            measure(what, megabytes * 1000000);
    } catch (const std::exception& failure) {
        fmt::print(stderr, "dump_bench: {}\n", failure.what());
        return 1;
    }
    return 0;
}
