#pragma once

#include "render/film/film.h"

#include <filesystem>

namespace scree {

/// What a picture and a checkpoint must have in common, so that the picture can continue from the checkpoint.
struct CheckpointKey {
    uint64_t scene_hash = 0; ///< of the scene, its input and everything else that decides a sample
    uint64_t seed = 0;
};

/// Writes all sums of the film, so that a resumed render is the same to the bit; the file appears whole or not at all.
void write_checkpoint(const std::filesystem::path& path, const Film& film, const CheckpointKey& key);

/// Fills the film from a checkpoint. Throws InputError when the file is damaged or of another picture.
void read_checkpoint(const std::filesystem::path& path, Film& film, const CheckpointKey& key);

} // namespace scree
