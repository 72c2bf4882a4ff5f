#include "ingest/particles/dump_series.h"

#include "base/error.h"
#include "ingest/particles/dump_index.h"
#include "ingest/particles/dump_rows.h"
#include "ingest/particles/file_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <set>

namespace scree {

namespace {

// Packed files that unpack to no more than this are kept, so that opening and reading unpacks them once.
constexpr size_t kept_bytes = size_t{256} << 20;

struct FileEntry {
    std::filesystem::path path;
    std::shared_ptr<const std::string> text; ///< the unpacked file, when kept
    bool single_frame = false;
};

struct FrameEntry {
    size_t file = 0;
    DumpHeader header;
};

/// An open file that stands behind the frame read last.
struct Cursor {
    size_t file = 0;
    std::unique_ptr<LineReader> reader;
};

} // namespace

bool is_start_of_dump(std::string_view start) { return start.starts_with("ITEM:"); }

std::unique_ptr<ParticleSeries> open_dump(const std::string& pattern, const std::vector<std::filesystem::path>& files,
                                          const Progress& progress)
{
    return std::make_unique<DumpSeries>(pattern, files, progress);
}

struct DumpSeries::Impl {
    std::string pattern;
    std::vector<FileEntry> files;
    std::vector<FrameEntry> frames;
    std::vector<std::string> type_names, warnings;

    std::mutex mutex; ///< guards cursor and the texts
    Cursor cursor;

    const FrameEntry& frame(size_t index) const
    {
        if (index < frames.size()) return frames[index];
        throw InputError(pattern, fmt::format("frame {}", index),
                         frames.size() == 1 ? "frame 0, the only one"
                                            : fmt::format("a frame from 0 to {}", frames.size() - 1));
    }

    std::unique_ptr<LineReader> reader_at(const FrameEntry& entry);
    void give_back(const FrameEntry& entry, std::unique_ptr<LineReader> reader);
    void add_files(const std::vector<std::filesystem::path>& paths, const Progress& progress);
    void check_steps();
};

/// A reader at the frame's first atom: the one left behind by the frame before if that is near, else a new one.
std::unique_ptr<LineReader> DumpSeries::Impl::reader_at(const FrameEntry& entry)
{
    std::unique_ptr<LineReader> reader;
    std::shared_ptr<const std::string> text;
    {
        const std::lock_guard lock(mutex);
        if (cursor.reader && cursor.file == entry.file) reader = std::move(cursor.reader);
        text = files[entry.file].text;
    }
    const uint64_t offset = entry.header.atoms_offset;
    if (reader && offset < reader->offset() && !reader->source().seekable()) reader.reset();
    const std::filesystem::path& path = files[entry.file].path;
    if (!reader) reader = std::make_unique<LineReader>(text ? ByteSource(path, text) : ByteSource(path));
    if (!reader->skip_to(offset, entry.header.atoms_line))
        throw InputError(fmt::format("{}:{}", path.string(), entry.header.atoms_line), "the end of the file",
                         "the atoms of the frame", "has the file changed since it was opened?");
    return reader;
}

void DumpSeries::Impl::give_back(const FrameEntry& entry, std::unique_ptr<LineReader> reader)
{
    const std::lock_guard lock(mutex);
    FileEntry& file = files[entry.file];
    if (file.single_frame) {
        // Read once, and seldom again: neither the text nor the file is worth holding.
        file.text.reset();
        cursor.reader.reset();
        return;
    }
    cursor = {entry.file, std::move(reader)};
}

void DumpSeries::Impl::add_files(const std::vector<std::filesystem::path>& paths, const Progress& progress)
{
    struct Indexed {
        std::filesystem::path path;
        DumpFileIndex index;
    };
    std::vector<Indexed> indexed;
    std::optional<InputError> truncation;
    std::set<std::string, std::less<>> names;
    size_t room = kept_bytes;
    for (size_t i = 0; i < paths.size(); ++i) {
        const auto update = [&](double fraction) {
            progress.update("find frames", (double(i) + fraction) / double(paths.size()));
        };
        DumpFileIndex index = index_dump_file(paths[i], room, update, progress);
        if (index.text) room -= std::min(room, index.text->size());
        if (index.truncation && !truncation) truncation = index.truncation;
        for (const std::string& note : index.notes) warnings.push_back(fmt::format("{}: {}", paths[i].string(), note));
        if (index.truncation)
            warnings.push_back(fmt::format("{}; {}", index.truncation->what(),
                                           index.frames.empty() ? "the file has no whole frame and is left out"
                                                                : "its last, unfinished frame is left out"));
        names.merge(index.type_names);
        if (!index.frames.empty()) indexed.push_back({paths[i], std::move(index)});
    }
    if (indexed.empty()) throw *truncation;

    std::ranges::stable_sort(indexed, {}, [](const Indexed& entry) { return entry.index.frames.front().step; });
    for (Indexed& entry : indexed) {
        for (DumpHeader& header : entry.index.frames) frames.push_back({files.size(), std::move(header)});
        files.push_back({std::move(entry.path), std::move(entry.index.text), entry.index.frames.size() == 1});
    }
    type_names.assign(names.begin(), names.end());
    if (!type_names.empty()) {
        std::string list;
        for (size_t i = 0; i < std::min<size_t>(type_names.size(), 12); ++i)
            list += fmt::format("{}{} = {}", i == 0 ? "" : ", ", i + 1, type_names[i]);
        warnings.push_back(fmt::format("{}: no column 'type': types are the names in alphabetical order: {}{}", pattern,
                                       list, type_names.size() > 12 ? ", ..." : ""));
    }
}

/// Tells of a step that comes twice, as it does when a run goes on from a restart.
void DumpSeries::Impl::check_steps()
{
    for (size_t i = 1; i < frames.size(); ++i) {
        if (frames[i].header.step != frames[i - 1].header.step) continue;
        warnings.push_back(fmt::format("{}: step {} comes twice, as frames {} and {}",
                                       files[frames[i].file].path.string(), frames[i].header.step, i - 1, i));
        return;
    }
}

DumpSeries::DumpSeries(const std::string& pattern, const std::vector<std::filesystem::path>& files,
                       const Progress& progress)
    : impl_(std::make_unique<Impl>())
{
    impl_->pattern = pattern;
    impl_->add_files(files, progress);
    impl_->check_steps();
}

DumpSeries::~DumpSeries() = default;
DumpSeries::DumpSeries(DumpSeries&&) noexcept = default;
DumpSeries& DumpSeries::operator=(DumpSeries&&) noexcept = default;

DumpSeries DumpSeries::open(const std::string& pattern, const Progress& progress)
{
    return {pattern, files_of_pattern(pattern), progress};
}

size_t DumpSeries::frame_count() const { return impl_->frames.size(); }
int64_t DumpSeries::step(size_t frame) const { return impl_->frame(frame).header.step; }
uint64_t DumpSeries::particle_count(size_t frame) const { return impl_->frame(frame).header.particles; }
std::optional<double> DumpSeries::time(size_t frame) const { return impl_->frame(frame).header.time; }
const std::vector<std::string>& DumpSeries::columns(size_t frame) const
{
    return impl_->frame(frame).header.columns->names;
}
bool DumpSeries::has_radius(size_t frame) const { return impl_->frame(frame).header.columns->has_radius; }
const std::vector<std::string>& DumpSeries::type_names() const { return impl_->type_names; }
const std::filesystem::path& DumpSeries::file(size_t frame) const
{
    return impl_->files[impl_->frame(frame).file].path;
}
const std::vector<std::string>& DumpSeries::warnings() const { return impl_->warnings; }

ParticleFrame DumpSeries::read(size_t frame, const ParticleReadOptions& options, const Progress& progress) const
{
    const FrameEntry& entry = impl_->frame(frame);
    std::unique_ptr<LineReader> reader = impl_->reader_at(entry);
    ParticleFrame result = read_dump_rows(*reader, entry.header, impl_->type_names, options, progress);
    impl_->give_back(entry, std::move(reader));
    return result;
}

} // namespace scree
