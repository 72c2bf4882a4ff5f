#include "ingest/particles/particle_series.h"

#include "base/byte_source.h"
#include "ingest/particles/dump_series.h"
#include "ingest/particles/file_pattern.h"
#include "ingest/particles/vdb_point_series.h"

#include <algorithm>

namespace scree {

const std::vector<ParticleFormat>& particle_formats()
{
    static const std::vector<ParticleFormat> formats{
        {"vdb", "OpenVDB points", is_start_of_vdb, open_vdb_points},
        {"lammps", "LAMMPS dump", is_start_of_dump, open_dump},
    };
    return formats;
}

const ParticleFormat& format_of(const std::filesystem::path& file)
{
    std::string start(ParticleFormat::start_bytes, '\0');
    start.resize(ByteSource(file).read(start.data(), start.size()));
    const auto& formats = particle_formats();
    const auto format = std::ranges::find_if(formats, [&](const ParticleFormat& f) { return f.recognises(start); });
    return format != formats.end() ? *format : formats.back();
}

OpenedParticles open_particles(const std::string& pattern, const Progress& progress)
{
    const std::vector<std::filesystem::path> files = files_of_pattern(pattern);
    const ParticleFormat& format = format_of(files.front());
    return {&format, format.open(pattern, files, progress)};
}

} // namespace scree
