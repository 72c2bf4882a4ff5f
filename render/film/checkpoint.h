#pragma once

#include "render/film/film.h"

#include <filesystem>

namespace scree {

/// What a picture must share with a checkpoint to be continued from it.
struct CheckpointKey {
    uint64_t scene_hash = 0; ///< of the scene, its input and what else decides a sample
    uint64_t seed = 0;
};

/// Writes all sums of the film, so that a render can go on to the bit. Appears whole or not at all.
void write_checkpoint(const std::filesystem::path& path, const Film& film, const CheckpointKey& key);

/// Fills the film from a checkpoint. Throws InputError when the file is damaged or of another picture.
void read_checkpoint(const std::filesystem::path& path, Film& film, const CheckpointKey& key);

} // namespace scree
