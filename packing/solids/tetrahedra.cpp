#include "packing/solids/tetrahedra.h"

#include "base/program_folder.h"
#include "base/worker_process.h"
#include "ingest/meshes/weld.h"
#include "packing/solids/tetgen_message.h"

#include <Imath/ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace scree {

namespace {

using Imath::V3d;

/// The surface as it is sent: one point per place, no unused points, about 1 in size around the origin.
struct Message {
    std::vector<V3d> places; ///< of the points, before scaling
    std::vector<V3d> points;
    std::vector<uint32_t> corners;
    V3d middle{0};
    int exponent = 0;

    V3d sent(const V3d& p) const
    {
        const V3d d = p - middle;
        return {std::scalbn(d.x, -exponent), std::scalbn(d.y, -exponent), std::scalbn(d.z, -exponent)};
    }
    V3d received(const V3d& p) const
    {
        return middle + V3d(std::scalbn(p.x, exponent), std::scalbn(p.y, exponent), std::scalbn(p.z, exponent));
    }
};

Message message_of(const TriangleMesh& mesh)
{
    constexpr uint32_t unused = std::numeric_limits<uint32_t>::max();
    const std::vector<uint32_t> first = first_at_same_position(mesh.positions);
    std::vector<uint32_t> number(mesh.positions.size(), unused);
    Message message;
    Imath::Box3d bounds;
    for (const auto& triangle : mesh.triangles) {
        for (const uint32_t corner : triangle) {
            if (corner >= mesh.positions.size()) {
                message.corners.push_back(unused); // the worker refuses it
                continue;
            }
            uint32_t& n = number[first[corner]];
            if (n == unused) {
                n = static_cast<uint32_t>(message.places.size());
                message.places.push_back(mesh.positions[corner]);
                bounds.extendBy(mesh.positions[corner]);
            }
            message.corners.push_back(n);
        }
    }
    if (!bounds.isEmpty()) {
        message.middle = bounds.min * 0.5 + bounds.max * 0.5;
        const V3d half = bounds.max * 0.5 - bounds.min * 0.5;
        const double size = std::max({half.x, half.y, half.z});
        if (std::isfinite(size) && size > 0) message.exponent = std::ilogb(size);
    }
    for (const V3d& p : message.places) message.points.push_back(message.sent(p));
    return message;
}

template <class T>
void append(std::vector<char>& bytes, const T* values, size_t count)
{
    const size_t at = bytes.size();
    bytes.resize(at + count * sizeof(T));
    if (count > 0) std::memcpy(bytes.data() + at, values, count * sizeof(T));
}

/// Reads values from the front of the remaining bytes; false if there are too few.
template <class T>
bool take(std::span<const char>& bytes, T* values, size_t count)
{
    if (bytes.size() / sizeof(T) < count) return false;
    if (count > 0) std::memcpy(static_cast<void*>(values), bytes.data(), count * sizeof(T));
    bytes = bytes.subspan(count * sizeof(T));
    return true;
}

/// Reads the answer and checks all of it. False if it is no valid answer to the message.
bool read_answer(std::span<const char> bytes, const Message& message, Tetrahedra& result)
{
    TetgenHead head;
    if (!take(bytes, &head, 1) || head.magic != TetgenHead::answer) return false;
    if (head.points < message.points.size() || head.points > bytes.size() / sizeof(V3d) ||
        head.cells > bytes.size() / 20)
        return false;
    result.points.resize(head.points);
    result.cells.resize(head.cells);
    result.region.resize(head.cells);
    if (!take(bytes, result.points.data(), head.points) || !take(bytes, result.cells.data(), head.cells) ||
        !take(bytes, result.region.data(), head.cells) || !bytes.empty())
        return false;
    if (!std::equal(message.points.begin(), message.points.end(), result.points.begin())) return false;
    for (const auto& cell : result.cells)
        for (const uint32_t corner : cell)
            if (corner >= head.points) return false;
    for (const V3d& p : result.points)
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
    std::ranges::copy(message.places, result.points.begin());
    for (size_t k = message.places.size(); k < result.points.size(); ++k)
        result.points[k] = message.received(result.points[k]);
    return true;
}

std::string words_of_status(int status)
{
    switch (status) {
    case tetgen_threw + 1: return "it ran out of memory";
    case tetgen_threw + 2: return "an internal error";
    case tetgen_threw + 3: return "it found faces that intersect";
    case tetgen_threw + 4: return "it found features too small for it";
    case tetgen_threw + 5: return "it found faces too close for it";
    case 3: return "the message to it was damaged";
    case 4: return "it ran out of memory";
    default: return fmt::format("it ended with status {}", status);
    }
}

} // namespace

Tetrahedra tetrahedralize(const TriangleMesh& mesh, const TetgenOptions& options, std::string& trouble)
{
    const std::filesystem::path program =
        options.program.empty() ? folder_of_this_program() / "scree-tetgen" : options.program;
    std::error_code error;
    if (!std::filesystem::exists(program, error)) {
        trouble = fmt::format("there is no {}", program.string());
        return {};
    }
    const Message message = message_of(mesh);
    std::vector<char> bytes;
    const TetgenHead head{TetgenHead::request, message.points.size(), mesh.triangles.size()};
    append(bytes, &head, 1);
    append(bytes, message.points.data(), message.points.size());
    append(bytes, message.corners.data(), message.corners.size());

    const auto seconds = std::chrono::ceil<std::chrono::seconds>(options.time).count();
    const WorkerResult run = run_worker(program, {std::to_string(seconds), std::to_string(options.megabytes)}, bytes,
                                        options.time, options.megabytes << 20);
    Tetrahedra result;
    if (!run.finished)
        trouble = run.trouble.empty() ? words_of_status(run.status) : run.trouble;
    else if (!read_answer(run.output, message, result))
        trouble = "its answer makes no sense";
    else if (result.cells.empty())
        trouble = "it found nothing enclosed";
    if (!trouble.empty()) return {};
    return result;
}

} // namespace scree
