#pragma once

#include "render/gsdf/gsdf.h"

#include <filesystem>
#include <memory>

namespace scree {

/// Which GSDF a file holds, and the error it was made for.
struct GsdfTag {
    uint64_t key = 0; ///< see gsdf_key
    double error = 0; ///< that was asked for; GsdfQuality has the error reached
};

/// Writes a GSDF, whole or not at all, with a checksum. Throws InputError if the file cannot be written.
void write_gsdf(const std::filesystem::path& file, const Gsdf& gsdf, const GsdfTag& tag);

struct StoredGsdf {
    std::shared_ptr<const Gsdf> gsdf;
    GsdfTag tag;
};

/// Reads a GSDF. Throws InputError when the file is missing, of another version, or damaged.
StoredGsdf read_gsdf(const std::filesystem::path& file);

} // namespace scree
