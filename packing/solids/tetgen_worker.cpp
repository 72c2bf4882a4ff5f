// scree-tetgen SECONDS MEGABYTES: fills a closed surface from standard input with tetrahedra (TetGen).
//
// A separate program, so that nothing TetGen does with an input can harm the program that asked: TetGen may throw ints,
// write beyond its memory or never end. packing/solids/tetgen_message.h defines the messages.

#include "packing/solids/tetgen_message.h"

#include <sys/resource.h>
#include <tetgen.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

namespace {

constexpr int bad_input = 3, no_memory = 4, cannot_write = 5;

void limit(int resource, rlim_t most)
{
    const rlimit both{most, most};
    setrlimit(resource, &both);
}

bool read_all(int file, void* data, size_t bytes)
{
    auto* at = static_cast<char*>(data);
    while (bytes > 0) {
        const ssize_t got = read(file, at, bytes);
        if (got <= 0) return false;
        at += got;
        bytes -= static_cast<size_t>(got);
    }
    return true;
}

bool write_all(int file, const void* data, size_t bytes)
{
    const auto* at = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t put = write(file, at, bytes);
        if (put <= 0) return false;
        at += put;
        bytes -= static_cast<size_t>(put);
    }
    return true;
}

/// Returns false unless the input is a complete message. TetGen owns the memory; it is never freed here, because the
/// process ends.
bool read_surface(tetgenio& surface)
{
    scree::TetgenHead head;
    if (!read_all(STDIN_FILENO, &head, sizeof head) || head.magic != scree::TetgenHead::request) return false;
    constexpr uint64_t most = std::numeric_limits<int>::max() / 4;
    if (head.points > most || head.cells > most) return false;
    std::vector<uint32_t> corners(3 * head.cells);
    surface.firstnumber = 0;
    surface.numberofpoints = static_cast<int>(head.points);
    surface.pointlist = new REAL[3 * head.points];
    if (!read_all(STDIN_FILENO, surface.pointlist, 3 * head.points * sizeof(double))) return false;
    if (!read_all(STDIN_FILENO, corners.data(), corners.size() * sizeof(uint32_t))) return false;
    surface.numberoffacets = static_cast<int>(head.cells);
    surface.facetlist = new tetgenio::facet[head.cells];
    for (size_t k = 0; k < head.cells; ++k) {
        tetgenio::facet& facet = surface.facetlist[k];
        tetgenio::init(&facet);
        facet.numberofpolygons = 1;
        facet.polygonlist = new tetgenio::polygon[1];
        tetgenio::init(facet.polygonlist);
        facet.polygonlist->numberofvertices = 3;
        facet.polygonlist->vertexlist = new int[3];
        for (size_t c = 0; c < 3; ++c) {
            const uint32_t corner = corners[3 * k + c];
            if (corner >= head.points) return false;
            facet.polygonlist->vertexlist[c] = static_cast<int>(corner);
        }
    }
    return true;
}

bool write_tetrahedra(int file, const tetgenio& solid)
{
    const auto points = static_cast<uint64_t>(solid.numberofpoints),
               cells = static_cast<uint64_t>(solid.numberoftetrahedra);
    const scree::TetgenHead head{scree::TetgenHead::answer, points, cells};
    std::vector<uint32_t> corners;
    std::vector<int32_t> regions;
    for (uint64_t k = 0; k < cells; ++k) {
        for (uint64_t c = 0; c < 4; ++c) {
            const auto from = k * static_cast<uint64_t>(solid.numberofcorners) + c;
            corners.push_back(static_cast<uint32_t>(solid.tetrahedronlist[from]));
        }
        const auto attributes = static_cast<uint64_t>(solid.numberoftetrahedronattributes);
        regions.push_back(attributes > 0 ? static_cast<int32_t>(solid.tetrahedronattributelist[k * attributes]) : 0);
    }
    return write_all(file, &head, sizeof head) && write_all(file, solid.pointlist, 3 * points * sizeof(double)) &&
           write_all(file, corners.data(), corners.size() * sizeof(uint32_t)) &&
           write_all(file, regions.data(), regions.size() * sizeof(int32_t));
}

int work(int output)
{
    tetgenio surface, solid;
    if (!read_surface(surface)) return bad_input;
    // p: of a surface; Y: keeping its triangles whole; A: regions numbered; J: points keep their places; Q: quiet.
    char switches[] = "pYAJQ";
    tetrahedralize(switches, &surface, &solid);
    return write_tetrahedra(output, solid) ? 0 : cannot_write;
}

} // namespace

int main(int count, char** words)
{
    limit(RLIMIT_CORE, 0);
    if (count > 1) limit(RLIMIT_CPU, static_cast<rlim_t>(std::atoll(words[1])));
#ifndef __SANITIZE_ADDRESS__ // AddressSanitizer reserves terabytes of addresses
    if (count > 2) limit(RLIMIT_AS, static_cast<rlim_t>(std::atoll(words[2])) << 20);
#endif
    // TetGen prints to standard output: the answer goes to a copy of it, and what TetGen prints is discarded.
    const int output = dup(STDOUT_FILENO);
    if (output < 0 || std::freopen("/dev/null", "w", stdout) == nullptr) return cannot_write;
    int status = no_memory;
    try {
        status = work(output);
    } catch (int thrown) {
        status = scree::tetgen_threw + thrown;
    } catch (const std::bad_alloc&) {
    }
    std::_Exit(status); // TetGen's own clean-up cannot be trusted after a failure
}
