#pragma once

#include "ingest/particles/particle_frame.h"

#include <filesystem>
#include <memory>

namespace scree {

/// Writes points to one OpenVDB file as they come: memory does not depend on how many there are.
///
/// Each batch is a grid: "points", "points_part_1", ... `read_vdb_points` takes them together.
class VdbPointStream {
public:
    /// voxel: 0 for four mean radii of each batch. Throws InputError when the file cannot be written.
    explicit VdbPointStream(const std::filesystem::path& path, double voxel = 0);
    ~VdbPointStream();

    /// As write_vdb_points.
    void add(const ParticleFrame& batch);
    /// Completes the file. Throws InputError.
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
