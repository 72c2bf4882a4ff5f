#include "ingest/particles/dump_rows.h"

#include "base/text.h"
#include "ingest/particles/dump_row_parser.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <set>

namespace scree {

namespace {

/// Parses blocks on all threads; of several defects it always reports the first in the file.
void parse_blocks(const DumpRowParser& parser, const LineBlocks& lines, uint64_t first_row)
{
    const size_t count = lines.blocks.size();
    const uint64_t first_line = lines.blocks.front().first_line;
    std::vector<std::exception_ptr> failures(count);
    const auto work = [&](size_t i) {
        try {
            parser.parse(lines.blocks[i], first_row + (lines.blocks[i].first_line - first_line));
        } catch (...) {
            failures[i] = std::current_exception();
        }
    };
    if (count == 1)
        work(0);
    else
        tbb::parallel_for(size_t{0}, count, work);
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
}

/// Resizes an array and asks for large pages: first accesses and the scattered reads of sorting then cost far less.
template <class T>
void resize_large(std::vector<T>& values, uint64_t count)
{
    values.reserve(count);
    constexpr uintptr_t page = uintptr_t{1} << 21;
    const auto begin = (reinterpret_cast<uintptr_t>(values.data()) + page - 1) / page * page;
    const auto end = reinterpret_cast<uintptr_t>(values.data() + count) / page * page;
    if (end > begin) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
    values.resize(count);
}

void resize(ParticleFrame& frame, const DumpColumns& columns, uint64_t count)
{
    resize_large(frame.position, count);
    resize_large(frame.radius, count);
    resize_large(frame.type, count);
    resize_large(frame.id, count);
    if (columns.has_orientation) resize_large(frame.orientation, count);
}

[[noreturn]] void fail_duplicate(const std::string& file, const DumpHeader& header, uint64_t id, uint64_t first_row,
                                 uint64_t row)
{
    throw InputError(fmt::format("{}:{}", file, header.atoms_line + row),
                     fmt::format("id {} again: line {} has it already", id, header.atoms_line + first_row),
                     "every id once in a frame",
                     id == 0 ? "ids that are all 0 come from 'atom_modify id no': leave the column out" : "");
}

/// The rows, sorted by their ids. Throws when an id occurs twice.
std::vector<uint64_t> order_by_id(const std::vector<uint64_t>& id, const std::string& file, const DumpHeader& header)
{
    const auto [least, greatest] = std::ranges::minmax_element(id);
    const uint64_t first = *least;
    const uint64_t span = *greatest - first;
    // Ids of a simulation are nearly always 1..N with few gaps: then each id gets a slot, and no sort is needed.
    if (span < 4 * id.size()) {
        constexpr uint64_t empty = std::numeric_limits<uint64_t>::max();
        std::vector<uint64_t> slots;
        resize_large(slots, span + 1);
        std::ranges::fill(slots, empty);
        for (uint64_t row = 0; row < id.size(); ++row) {
            uint64_t& slot = slots[id[row] - first];
            if (slot != empty) fail_duplicate(file, header, id[row], slot, row);
            slot = row;
        }
        std::erase(slots, empty);
        return slots;
    }
    std::vector<uint64_t> order(id.size());
    for (uint64_t row = 0; row < order.size(); ++row) order[row] = row;
    tbb::parallel_sort(order.begin(), order.end(),
                       [&](uint64_t a, uint64_t b) { return id[a] != id[b] ? id[a] < id[b] : a < b; });
    uint64_t second = std::numeric_limits<uint64_t>::max(), before = 0;
    for (uint64_t i = 1; i < order.size(); ++i)
        if (id[order[i]] == id[order[i - 1]] && order[i] < second) {
            second = order[i];
            before = order[i - 1];
        }
    if (second != std::numeric_limits<uint64_t>::max()) fail_duplicate(file, header, id[second], before, second);
    return order;
}

template <class T>
void apply_order(std::vector<T>& values, const std::vector<uint64_t>& order)
{
    if (values.empty()) return;
    std::vector<T> sorted;
    resize_large(sorted, values.size());
    for (size_t i = 0; i < order.size(); ++i) sorted[i] = values[order[i]];
    values.swap(sorted);
}

void sort_by_id(ParticleFrame& frame, const std::string& file, const DumpHeader& header)
{
    const auto out_of_order = [](uint64_t a, uint64_t b) { return a >= b; };
    if (std::ranges::adjacent_find(frame.id, out_of_order) == frame.id.end()) return;
    const std::vector<uint64_t> order = order_by_id(frame.id, file, header);
    apply_order(frame.position, order);
    apply_order(frame.radius, order);
    apply_order(frame.type, order);
    apply_order(frame.id, order);
    apply_order(frame.orientation, order);
}

float checked_radius(double radius, const std::string& what)
{
    if (radius >= 0 && radius <= std::numeric_limits<float>::max()) return static_cast<float>(radius);
    throw InputError(what, fmt::format("{}", radius), "a radius, finite and 0 or more");
}

/// Sets the radii that the user gave, for a dump without radii.
void give_radii(ParticleFrame& frame, const std::string& file, const DumpHeader& header,
                const ParticleReadOptions& options, const std::vector<std::string>& type_names)
{
    if (options.radius) checked_radius(*options.radius, "--radius");
    for (const auto& [type, radius] : options.radius_of_type) checked_radius(radius, fmt::format("--radius {}=", type));

    std::set<int32_t> missing;
    for (size_t i = 0; i < frame.size(); ++i) {
        const auto own = options.radius_of_type.find(frame.type[i]);
        if (own != options.radius_of_type.end())
            frame.radius[i] = static_cast<float>(own->second);
        else if (options.radius)
            frame.radius[i] = static_cast<float>(*options.radius);
        else if (missing.size() < 100)
            missing.insert(frame.type[i]);
    }
    if (missing.empty()) return;
    std::string list, example;
    for (const int32_t type : missing) {
        list += fmt::format("{}{}", list.empty() ? "" : ", ", type);
        if (header.columns->has_name) list += fmt::format(" ({})", type_names.at(static_cast<size_t>(type - 1)));
        if (missing.size() <= 8) example += fmt::format(" {}=R", type);
    }
    throw InputError(
        fmt::format("{}:{}", file, header.atoms_line - 1),
        fmt::format("no column of radii, and no radius for type{} {}", missing.size() == 1 ? "" : "s", list),
        "a column radius or diameter, or a radius for every type",
        fmt::format("give one for all types: --radius R, or by type: --radius{}",
                    example.empty() ? " TYPE=R ..." : example));
}

} // namespace

ParticleFrame read_dump_rows(LineReader& reader, const DumpHeader& header, const std::vector<std::string>& type_names,
                             const ParticleReadOptions& options, const Progress& progress)
{
    const std::string file = reader.source().path().string();
    ParticleFrame frame;
    frame.step = header.step;
    frame.time = header.time;
    frame.units = header.units;
    frame.box = header.box;
    frame.has_ids = header.columns->has_id;
    resize(frame, *header.columns, header.particles);

    const DumpRowParser parser(header, type_names, file, frame);
    uint64_t row = 0;
    while (row < header.particles) {
        if (progress.cancelled()) throw Cancelled();
        const LineBlocks lines = reader.next_block(header.particles - row, "ITEM:");
        if (lines.lines == 0)
            throw InputError(fmt::format("{}:{}", file, header.atoms_line + row),
                             fmt::format("the end of the frame after {} lines of atoms", row),
                             fmt::format("{} lines of atoms", header.particles),
                             "has the file changed since it was opened?");
        parse_blocks(parser, lines, row);
        row += lines.lines;
        progress.update("read particles", double(row) / double(header.particles));
    }

    if (frame.has_ids)
        sort_by_id(frame, file, header);
    else
        for (uint64_t i = 0; i < header.particles; ++i) frame.id[i] = i;
    if (!header.columns->has_radius) give_radii(frame, file, header, options, type_names);
    frame.origin = middle_of_bounds(frame.position);
    return frame;
}

} // namespace scree
