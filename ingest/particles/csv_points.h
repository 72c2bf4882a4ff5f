#pragma once

#include "ingest/particles/particle_frame.h"

#include <filesystem>

namespace scree {

/// Writes a frame as text: a line of names (id,type,x,y,z,radius and, if the frame has orientations, quatw,quati,
/// quatj,quatk), then one line per sphere. Numbers read back exactly. Throws InputError when writing fails.
void write_csv_points(const ParticleFrame& frame, const std::filesystem::path& path);

} // namespace scree
