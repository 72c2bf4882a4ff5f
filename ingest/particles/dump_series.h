#pragma once

#include "ingest/particles/particle_series.h"

namespace scree {

/// Whether a file that begins like this is a LAMMPS or LIGGGHTS text dump.
bool is_start_of_dump(std::string_view start);

/// The frames of LAMMPS text dumps: one file of many frames, or many files of one or more frames each.
///
/// Opening finds where every frame starts without holding a file in memory. Reading frames in their order passes each
/// file once.
class DumpSeries final : public ParticleSeries {
public:
    /// As open_particles(); .gz and .zst are unpacked on the way. Files are ordered by their first step, frames within
    /// a file as they stand. A truncated last frame is left out, which `warnings()` tells.
    static DumpSeries open(const std::string& pattern, const Progress& progress = {});
    DumpSeries(const std::string& pattern, const std::vector<std::filesystem::path>& files, const Progress& progress);

    ~DumpSeries() override;
    DumpSeries(DumpSeries&&) noexcept;
    DumpSeries& operator=(DumpSeries&&) noexcept;

    size_t frame_count() const override;
    int64_t step(size_t frame) const override;
    uint64_t particle_count(size_t frame) const override;
    /// The time that `dump_modify time yes` writes.
    std::optional<double> time(size_t frame) const;
    const std::vector<std::string>& columns(size_t frame) const override;
    /// Whether the frame has a column of radii or diameters.
    bool has_radius(size_t frame) const override;
    /// From `element` or `typelabel`.
    const std::vector<std::string>& type_names() const override;
    const std::filesystem::path& file(size_t frame) const override;
    const std::vector<std::string>& warnings() const override;

    ParticleFrame read(size_t frame, const ParticleReadOptions& options = {},
                       const Progress& progress = {}) const override;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

std::unique_ptr<ParticleSeries> open_dump(const std::string& pattern, const std::vector<std::filesystem::path>& files,
                                          const Progress& progress);

} // namespace scree
