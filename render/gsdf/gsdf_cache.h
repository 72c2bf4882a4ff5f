#pragma once

#include "render/gsdf/gsdf_builder.h"

#include <filesystem>
#include <functional>
#include <string>

namespace scree {

/// What a GSDF is wanted of.
struct GsdfSource {
    uint64_t shape = 0; ///< hash of what the shape is; the same for the same shape in every run
    Material material; ///< absorption, tint and reflectance do not matter
    /// Makes the shape, when it must be traced; a null pointer is the sphere itself.
    std::function<std::shared_ptr<const Exemplar>()> exemplar;
};

struct FoundGsdf {
    std::shared_ptr<const Gsdf> gsdf;
    bool computed = false; ///< and not found in the cache
    std::string remark; ///< why a stored one was not used, or why it could not be stored; may be empty
    std::filesystem::path file;
};

/// The folder of precomputed tables: $SCREE_CACHE, else $XDG_CACHE_HOME/scree, else ~/.cache/scree; empty when none is
/// set.
std::filesystem::path cache_folder();

/// Names what decides a GSDF, to the bit: shape, what of the material matters, and options. So a picture does not
/// depend on what else a cache holds.
uint64_t gsdf_key(const GsdfSource& source, const GsdfOptions& options);

/// The GSDF if it is in `folder`; else none, and perhaps a remark.
FoundGsdf stored_gsdf(const GsdfSource& source, const GsdfOptions& options, const std::filesystem::path& folder);

/// The GSDF from `folder`, else made and kept there. A damaged or outdated file is made again. Without a folder, or
/// when it cannot be written, it is made for this run only.
FoundGsdf find_gsdf(const GsdfSource& source, const GsdfOptions& options, const std::filesystem::path& folder,
                    const Progress& progress = {});

/// The GSDF made anew and kept in `folder`, whatever is there.
FoundGsdf make_gsdf(const GsdfSource& source, const GsdfOptions& options, const std::filesystem::path& folder,
                    const Progress& progress = {});

} // namespace scree
