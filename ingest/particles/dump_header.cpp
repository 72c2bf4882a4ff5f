#include "ingest/particles/dump_header.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr std::string_view item_mark = "ITEM:";

const std::vector<std::string> known_items{"TIMESTEP", "NUMBER OF ATOMS", "BOX BOUNDS", "ATOMS", "UNITS", "TIME"};

/// Thrown when the file ends inside a header; caught within this source file.
struct Truncated {
    InputError error;
};

class HeaderReader {
public:
    HeaderReader(LineReader& reader, const DumpHeader* previous) : reader_(reader), previous_(previous) {}

    /// Nothing when the file ends before a header begins.
    std::optional<DumpHeader> read();

private:
    std::string place(uint64_t line) const { return fmt::format("{}:{}", reader_.source().path().string(), line); }
    bool at_first_line(const TextLine& line) const { return line.number == 1; }

    [[noreturn]] void cut(uint64_t line, const std::string& expected) const
    {
        throw Truncated{InputError(
            place(line), reader_.source().truncated() ? "the end of truncated compressed data" : "the end of the file",
            expected, "was the file copied whole, or is it still being written?")};
    }

    std::optional<std::string> next_item();
    std::string value_line(const std::string& expected);
    void take_item(const std::string& item);
    void take_box(std::string_view rest);
    void take_atoms(std::string_view rest);
    void once(bool& seen, const char* item);

    LineReader& reader_;
    const DumpHeader* previous_;
    DumpHeader header_;
    bool started_ = false;
    bool has_step_ = false, has_count_ = false, has_box_ = false, has_units_ = false, has_time_ = false, done_ = false;
    uint64_t item_line_ = 0;
};

/// What follows "ITEM:" on the next line that is not blank; nothing at the end of the file.
std::optional<std::string> HeaderReader::next_item()
{
    for (;;) {
        const std::optional<TextLine> line = reader_.next();
        if (!line) return std::nullopt;
        std::string_view text = line->text;
        if (at_first_line(*line) && text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
        const std::vector<std::string_view> words = split_words(text);
        if (words.empty()) continue;
        item_line_ = line->number;
        if (words[0] != item_mark) {
            // The file may be cut inside the word "ITEM:"; other text is an error.
            if (!line->terminated && item_mark.starts_with(text)) cut(item_line_, "ITEM: TIMESTEP");
            if (!started_ && !previous_)
                throw InputError(place(item_line_), in_quotes(text), "ITEM: TIMESTEP",
                                 "is this a text dump written by LAMMPS or LIGGGHTS?");
            if (!started_)
                throw InputError(place(item_line_), in_quotes(text), "ITEM: TIMESTEP, or the end of the file",
                                 fmt::format("NUMBER OF ATOMS promised {} lines of atoms", previous_->particles));
            throw InputError(place(item_line_), in_quotes(text), "the next ITEM: of the frame's header");
        }
        const std::string item = fmt::format("{}", fmt::join(words.begin() + 1, words.end(), " "));
        // If no atoms follow, the last line is complete even without a line end.
        const bool last_of_empty = item.starts_with("ATOMS ") && has_count_ && header_.particles == 0;
        if (!line->terminated && !last_of_empty) {
            for (const std::string& known : known_items)
                if (known.starts_with(item) || item.starts_with(known)) cut(item_line_, "a whole frame");
        }
        return item;
    }
}

/// The line under an ITEM:.
std::string HeaderReader::value_line(const std::string& expected)
{
    const std::optional<TextLine> line = reader_.next();
    if (!line || !line->terminated) cut(line ? line->number : reader_.line(), expected);
    return std::string(line->text);
}

void HeaderReader::once(bool& seen, const char* item)
{
    if (seen)
        throw InputError(place(item_line_), fmt::format("ITEM: {} twice in one frame", item),
                         "ITEM: ATOMS between two frames",
                         "a run that was stopped and continued in the same file leaves half a frame: remove it");
    seen = true;
}

void HeaderReader::take_box(std::string_view rest)
{
    once(has_box_, "BOX BOUNDS");
    std::vector<std::string> words;
    for (const std::string_view word : split_words(rest)) words.emplace_back(word);
    std::array<std::string, 3> rows;
    for (std::string& row : rows) {
        row = value_line("three lines of box bounds");
        if (row.starts_with(item_mark))
            throw InputError(place(reader_.line() - 1), in_quotes(row),
                             "three lines of box bounds under ITEM: BOX BOUNDS");
    }
    header_.box = parse_dump_box(words, rows, reader_.source().path().string(), item_line_);
}

void HeaderReader::take_atoms(std::string_view rest)
{
    const auto missing = [&](const char* item) {
        throw InputError(place(item_line_), fmt::format("ITEM: ATOMS without ITEM: {} before it", item),
                         fmt::format("ITEM: {} in the header of every frame", item));
    };
    if (!has_step_) missing("TIMESTEP");
    if (!has_count_) missing("NUMBER OF ATOMS");
    const std::vector<std::string_view> words = split_words(rest);
    if (previous_ && std::ranges::equal(words, previous_->columns->names))
        header_.columns = previous_->columns;
    else
        header_.columns = std::make_shared<const DumpColumns>(plan_dump_columns(words, place(item_line_)));
    if (header_.columns->any_scaled() && !header_.box)
        throw InputError(place(item_line_), "scaled coordinates (xs, ys or zs) without ITEM: BOX BOUNDS",
                         "the box that they are fractions of");
    done_ = true;
}

void HeaderReader::take_item(const std::string& item)
{
    const auto integer = [&](const char* expected) {
        const std::string row = value_line(expected);
        const std::vector<std::string_view> words = split_words(row);
        const std::optional<int64_t> value = words.size() == 1 ? to_int64(words[0]) : std::nullopt;
        if (!value) throw InputError(place(reader_.line() - 1), in_quotes(row), expected);
        return *value;
    };
    if (item == "TIMESTEP") {
        once(has_step_, "TIMESTEP");
        header_.step = integer("the step, an integer, under ITEM: TIMESTEP");
    } else if (item == "NUMBER OF ATOMS") {
        once(has_count_, "NUMBER OF ATOMS");
        const int64_t count = integer("the number of atoms, an integer of 0 or more");
        if (count < 0)
            throw InputError(place(reader_.line() - 1), fmt::format("{} atoms", count),
                             "the number of atoms, an integer of 0 or more");
        header_.particles = static_cast<uint64_t>(count);
    } else if (item == "BOX BOUNDS" || item.starts_with("BOX BOUNDS ")) {
        take_box(std::string_view(item).substr(10));
    } else if (item == "ATOMS" || item.starts_with("ATOMS ")) {
        take_atoms(std::string_view(item).substr(5));
    } else if (item == "UNITS") {
        once(has_units_, "UNITS");
        const std::string row = value_line("the unit style, as in 'lj' or 'si'");
        const std::vector<std::string_view> words = split_words(row);
        if (words.size() != 1 || words[0] == item_mark)
            throw InputError(place(reader_.line() - 1), in_quotes(row), "the unit style, one word, under ITEM: UNITS");
        header_.units = std::string(words[0]);
    } else if (item == "TIME") {
        once(has_time_, "TIME");
        const std::string row = value_line("the time under ITEM: TIME");
        const std::vector<std::string_view> words = split_words(row);
        const std::optional<double> time = words.size() == 1 ? to_double(words[0]) : std::nullopt;
        if (!time || !std::isfinite(*time))
            throw InputError(place(reader_.line() - 1), in_quotes(row), "the time, a finite number, under ITEM: TIME");
        header_.time = *time;
    } else if (item.starts_with("NUMBER OF ENTRIES") || item.starts_with("ENTRIES") ||
               item.starts_with("NUMBER OF GRID")) {
        throw InputError(place(item_line_), in_quotes("ITEM: " + item), "a dump of atoms",
                         "this is a 'dump local' or 'dump grid' file: write one with 'dump custom'");
    } else {
        throw InputError(place(item_line_), "an unknown item, " + in_quotes("ITEM: " + item),
                         "one of: " + join_words(known_items) + did_you_mean(item, known_items));
    }
}

std::optional<DumpHeader> HeaderReader::read()
{
    if (previous_) header_.units = previous_->units;
    while (!done_) {
        const std::optional<std::string> item = next_item();
        if (!item) {
            if (!started_) return std::nullopt;
            cut(reader_.line(), "the rest of the frame's header, up to ITEM: ATOMS");
        }
        started_ = true;
        take_item(*item);
    }
    header_.atoms_line = reader_.line();
    header_.atoms_offset = reader_.offset();
    return std::move(header_);
}

} // namespace

DumpHeaderResult read_dump_header(LineReader& reader, const DumpHeader* previous)
{
    try {
        return {HeaderReader(reader, previous).read(), std::nullopt};
    } catch (const Truncated& truncated) {
        return {std::nullopt, truncated.error};
    }
}

} // namespace scree
