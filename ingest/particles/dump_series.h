#pragma once

#include "base/progress.h"
#include "ingest/particles/particle_frame.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// How spheres get their radius when a dump has no `radius` or `diameter` column.
struct DumpReadOptions {
    std::optional<double> radius; ///< for every type
    std::map<int32_t, double> radius_of_type; ///< takes precedence over `radius`
};

/// The frames of a LAMMPS text dump: one file of many frames, or many files of one or more frames each.
///
/// `open` finds where every frame starts without holding a file in memory; `read` parses one frame.
class DumpSeries {
public:
    /// pattern: a file, a glob ("pour.*.dump.gz") or a printf pattern ("pour.%04d.dump"); .gz and .zst are read
    /// as they are. Files are ordered by their first step, frames within a file as they stand.
    /// Throws InputError. A truncated last frame is left out and told in `warnings()`.
    static DumpSeries open(const std::string& pattern, const Progress& progress = {});

    ~DumpSeries();
    DumpSeries(DumpSeries&&) noexcept;
    DumpSeries& operator=(DumpSeries&&) noexcept;

    size_t frame_count() const;
    int64_t step(size_t frame) const;
    uint64_t particle_count(size_t frame) const;
    /// The time that `dump_modify time yes` writes.
    std::optional<double> time(size_t frame) const;
    /// The names of the frame's columns, as the file spells them.
    const std::vector<std::string>& columns(size_t frame) const;
    /// Whether the frame has a column of radii or diameters; without one, `read` needs them in its options.
    bool has_radius(size_t frame) const;
    /// The names of types 1, 2, ... where the dump tells types by name (`element`, `typelabel`) only; else empty.
    const std::vector<std::string>& type_names() const;
    /// File that holds the frame.
    const std::filesystem::path& file(size_t frame) const;

    /// Parses one frame, sorted by id. Reading frames in their order passes each file once; may be called from
    /// several threads. Throws InputError naming file, line, found and expected.
    ParticleFrame read(size_t frame, const DumpReadOptions& options = {}, const Progress& progress = {}) const;

    const std::vector<std::string>& warnings() const;

private:
    struct Impl;
    explicit DumpSeries(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
