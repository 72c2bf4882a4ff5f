#include "ingest/particles/dump_index.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>

namespace scree {

namespace {

constexpr size_t most_type_names = 1000;

class Indexer {
public:
    Indexer(LineReader& reader, DumpFileIndex& index, const std::function<void(double)>& update,
            const Progress& progress)
        : reader_(reader), index_(index), update_(update), progress_(progress)
    {
    }

    void run();

private:
    std::string place(uint64_t line) const { return fmt::format("{}:{}", reader_.source().path().string(), line); }
    bool pass_atoms(const DumpHeader& header);
    void collect_names(const DumpHeader& header, const LineBlock& block);
    bool last_line_is_whole(const DumpHeader& header, const LineBlock& block);
    void note(const std::string& text);

    LineReader& reader_;
    DumpFileIndex& index_;
    const std::function<void(double)>& update_;
    const Progress& progress_;
    std::string last_name_;
};

void Indexer::run()
{
    for (;;) {
        const DumpHeader* previous = index_.frames.empty() ? nullptr : &index_.frames.back();
        DumpHeaderResult found = read_dump_header(reader_, previous);
        if (found.truncation) index_.truncation = std::move(found.truncation);
        if (!found.header) break;
        if (!pass_atoms(*found.header)) break;
        if (!found.header->columns->note.empty()) note(found.header->columns->note);
        if (!found.header->box) note("no ITEM: BOX BOUNDS: there is no box, and nothing is periodic");
        index_.frames.push_back(std::move(*found.header));
    }
    // Compressed data may also be cut exactly between two frames.
    if (!index_.truncation && reader_.source().truncated())
        index_.truncation = InputError(place(reader_.line()), "the end of truncated compressed data", "a whole file",
                                       "copy or write the file again");
}

void Indexer::note(const std::string& text)
{
    if (std::ranges::find(index_.notes, text) == index_.notes.end()) index_.notes.push_back(text);
}

/// Passes over the frame's lines of atoms; if the file ends too early, sets index_.truncation and returns false.
bool Indexer::pass_atoms(const DumpHeader& header)
{
    uint64_t passed = 0;
    while (passed < header.particles) {
        if (progress_.cancelled()) throw Cancelled();
        update_(reader_.source().fraction());
        const LineBlocks lines = reader_.next_block(header.particles - passed, "ITEM:");
        passed += lines.lines;
        if (lines.lines == 0) {
            const std::optional<TextLine> next = reader_.next();
            const bool cut_item = next && !next->terminated;
            const std::string expected =
                fmt::format("{} lines of atoms (NUMBER OF ATOMS of step {})", header.particles, header.step);
            if (next && !cut_item)
                throw InputError(place(next->number),
                                 fmt::format("{} after {} lines of atoms", in_quotes(next->text), passed), expected,
                                 "a run that was stopped and continued in the same file leaves half a frame: remove "
                                 "it");
            const char* end =
                reader_.source().truncated() ? "the end of truncated compressed data" : "the end of the file";
            index_.truncation = InputError(place(next ? next->number : reader_.line()),
                                           fmt::format("{} after {} lines of atoms", end, passed), expected,
                                           "was the file copied whole, or is it still being written?");
            return false;
        }
        if (header.columns->has_name)
            for (const LineBlock& block : lines.blocks) collect_names(header, block);
        if (!lines.terminated && passed == header.particles && !last_line_is_whole(header, lines.blocks.back()))
            return false;
    }
    return true;
}

/// Collects the type names of all frames together, so that a name has the same number in every frame.
void Indexer::collect_names(const DumpHeader& header, const LineBlock& block)
{
    const auto& fields = header.columns->fields;
    const size_t column = static_cast<size_t>(std::ranges::find(fields, DumpField::name) - fields.begin());
    size_t start = 0;
    for (uint64_t i = 0; i < block.lines; ++i) {
        const size_t end = block.text.find('\n', start);
        const std::vector<std::string_view> words = split_words(block.text.substr(start, end - start));
        start = end + 1;
        if (words.size() <= column || words[column] == last_name_) continue;
        last_name_ = std::string(words[column]);
        index_.type_names.insert(last_name_);
        if (index_.type_names.size() > most_type_names)
            throw InputError(place(block.first_line + i),
                             fmt::format("more than {} different type names", most_type_names),
                             "a few different type names in column " + in_quotes(header.columns->names[column]));
    }
}

/// Whether the file's last line, which has no line end, has all columns; if not, sets index_.truncation.
bool Indexer::last_line_is_whole(const DumpHeader& header, const LineBlock& block)
{
    const size_t before = block.text.rfind('\n', block.text.size() - 2);
    const size_t start = before == std::string_view::npos ? 0 : before + 1;
    const size_t words = split_words(block.text.substr(start)).size();
    const uint64_t line = block.first_line + block.lines - 1;
    if (words >= header.columns->names.size() && !reader_.source().truncated()) {
        note(fmt::format("the last line ({}) has no line end: its last number may be cut off", line));
        return true;
    }
    index_.truncation = InputError(place(line), fmt::format("the end of the file after {} columns", words),
                                   fmt::format("{} columns and a line end", header.columns->names.size()),
                                   "was the file copied whole, or is it still being written?");
    return false;
}

} // namespace

DumpFileIndex index_dump_file(const std::filesystem::path& path, size_t keep, const std::function<void(double)>& update,
                              const Progress& progress)
{
    DumpFileIndex index;
    ByteSource source(path);
    const bool packed = !source.seekable();
    if (packed) source.keep(keep);
    LineReader reader(std::move(source));
    Indexer(reader, index, update, progress).run();
    if (index.frames.empty() && !index.truncation)
        index.truncation =
            InputError(path.string(), "an empty file", "ITEM: TIMESTEP", "has the simulation written anything yet?");
    if (packed) index.text = reader.source().kept();
    return index;
}

} // namespace scree
