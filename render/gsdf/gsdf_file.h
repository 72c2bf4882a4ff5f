#pragma once

#include "render/gsdf/gsdf.h"

#include <filesystem>
#include <memory>

namespace scree {

/// What a stored GSDF is of and how well it was wanted.
struct GsdfTag {
    uint64_t key = 0; ///< see gsdf_key
    double error = 0; ///< that was asked for; what was reached stands in its quality
};

/// Writes a GSDF, whole or not at all, under a checksum. Throws InputError where that is not possible.
void write_gsdf(const std::filesystem::path& file, const Gsdf& gsdf, const GsdfTag& tag);

struct StoredGsdf {
    std::shared_ptr<const Gsdf> gsdf;
    GsdfTag tag;
};

/// Reads a GSDF. Throws InputError when the file is missing, of another version, or damaged.
StoredGsdf read_gsdf(const std::filesystem::path& file);

} // namespace scree
