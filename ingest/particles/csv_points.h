#pragma once

#include "ingest/particles/particle_frame.h"

#include <filesystem>

namespace scree {

/// Writes a frame as text: a line of names (id,type,x,y,z,radius and, where there are orientations, quatw,quati,
/// quatj,quatk), then a line a sphere; numbers read back as the same ones. Throws InputError when writing fails.
void write_csv_points(const ParticleFrame& frame, const std::filesystem::path& path);

} // namespace scree
