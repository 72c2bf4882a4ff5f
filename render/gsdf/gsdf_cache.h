#pragma once

#include "render/gsdf/gsdf_builder.h"

#include <filesystem>
#include <functional>
#include <string>

namespace scree {

/// The grain whose GSDF is wanted.
struct GsdfSource {
    uint64_t shape = 0; ///< hash of the shape; the same for the same shape in every run
    Material material; ///< absorption, tint and reflectance do not matter
    /// Makes the shape, called only when it must be traced; a null pointer is the sphere itself.
    std::function<std::shared_ptr<const Exemplar>()> exemplar;
};

struct FoundGsdf {
    std::shared_ptr<const Gsdf> gsdf;
    bool computed = false; ///< traced now, not found in the cache
    std::string remark; ///< why a stored one was not used, or why it could not be stored; may be empty
    std::filesystem::path file;
};

/// The folder of precomputed tables: $SCREE_CACHE, else $XDG_CACHE_HOME/scree, else ~/.cache/scree; empty when none is
/// set.
std::filesystem::path cache_folder();

/// A hash of everything that decides a GSDF, to the bit: shape, the relevant part of the material, and options. So a
/// picture does not depend on what else a cache holds.
uint64_t gsdf_key(const GsdfSource& source, const GsdfOptions& options);

/// The GSDF if it is in `folder`; else none, and perhaps a remark.
FoundGsdf stored_gsdf(const GsdfSource& source, const GsdfOptions& options, const std::filesystem::path& folder);

/// Reads the GSDF from `folder`, or else makes it and keeps it there. A damaged or outdated file is made again. Without
/// a folder, or when the file cannot be written, the GSDF is made for this run only.
FoundGsdf find_gsdf(const GsdfSource& source, const GsdfOptions& options, const std::filesystem::path& folder,
                    const Progress& progress = {});

/// Makes the GSDF and keeps it in `folder`, even if `folder` has it already.
FoundGsdf make_gsdf(const GsdfSource& source, const GsdfOptions& options, const std::filesystem::path& folder,
                    const Progress& progress = {});

} // namespace scree
