#pragma once

#include "ingest/particles/particle_frame.h"

#include <filesystem>
#include <memory>

namespace scree {

/// Writes points to one OpenVDB file batch by batch, so that memory does not depend on the number of points.
///
/// Each batch becomes a grid: "points", "points_part_1", ... `read_vdb_points` reads these grids as one frame.
class VdbPointStream {
public:
    /// voxel: width of a voxel; 0 means four mean radii of each batch. Throws InputError when the file cannot be
    /// written.
    explicit VdbPointStream(const std::filesystem::path& path, double voxel = 0);
    ~VdbPointStream();

    /// Writes one batch as a grid; contents and errors as in `write_vdb_points`.
    void add(const ParticleFrame& batch);
    /// Completes the file. Throws InputError.
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
