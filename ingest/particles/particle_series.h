#pragma once

#include "base/progress.h"
#include "ingest/particles/particle_frame.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// How spheres get their radius when a file holds none.
struct ParticleReadOptions {
    std::optional<double> radius; ///< for every type
    std::map<int32_t, double> radius_of_type; ///< takes precedence over `radius`
};

/// The frames of a simulation's particle files, whatever their format.
///
/// Opening finds the frames; `read` reads one. Every function that takes a frame throws InputError where there is none.
class ParticleSeries {
public:
    virtual ~ParticleSeries() = default;

    virtual size_t frame_count() const = 0;
    virtual int64_t step(size_t frame) const = 0;
    virtual uint64_t particle_count(size_t frame) const = 0;
    /// The names of the frame's columns, as the file spells them; empty where a format has none.
    virtual const std::vector<std::string>& columns(size_t frame) const = 0;
    /// Whether the frame holds radii; without them, `read` needs some in its options.
    virtual bool has_radius(size_t frame) const = 0;
    /// The names of types 1, 2, ... where the files tell types by name only; else empty.
    virtual const std::vector<std::string>& type_names() const = 0;
    /// The file that holds the frame.
    virtual const std::filesystem::path& file(size_t frame) const = 0;
    /// Remarks that are no errors, such as a truncated last frame that is left out.
    virtual const std::vector<std::string>& warnings() const = 0;

    /// Reads one frame, sorted by id; may be called from several threads. Throws InputError naming file, place, found
    /// and expected.
    virtual ParticleFrame read(size_t frame, const ParticleReadOptions& options = {},
                               const Progress& progress = {}) const = 0;
};

/// A particle format: a new one is a row in particle_formats() and a ParticleSeries.
struct ParticleFormat {
    const char* name; ///< in `scree info --json`
    const char* title; ///< for people
    /// Whether a file is of this format, by its first bytes (unpacked), at most `start_bytes` of them.
    bool (*recognises)(std::string_view start);
    /// pattern: as the user wrote it, for messages; files: not empty, of one format.
    std::unique_ptr<ParticleSeries> (*open)(const std::string& pattern, const std::vector<std::filesystem::path>& files,
                                            const Progress& progress);

    static constexpr size_t start_bytes = 4096;
};

/// Every format that can be read. The last one is tried on what no format recognises: it tells what is wrong.
const std::vector<ParticleFormat>& particle_formats();

/// The format of a file, by its content and never by its name. Throws InputError when it cannot be read.
const ParticleFormat& format_of(const std::filesystem::path& file);

/// Particle files, and their format.
struct OpenedParticles {
    const ParticleFormat* format = nullptr;
    std::unique_ptr<ParticleSeries> series;
};

/// pattern: a file, a glob ("pour.*.dump.gz") or a printf pattern ("pour.%04d.dump"). The first file tells the format
/// of all. Throws InputError.
OpenedParticles open_particles(const std::string& pattern, const Progress& progress = {});

} // namespace scree
