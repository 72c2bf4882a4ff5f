#pragma once

#include "base/progress.h"
#include "render/stf/stf.h"

namespace scree {

struct StfOptions {
    uint64_t walks = uint64_t{1} << 17; ///< a shell, that scatter; 2^10 .. 2^24
    uint32_t records = uint32_t{1} << 15; ///< kept of each, 2^6 .. 2^20
    uint64_t seed = 1;
};

/// Adds shells until there are `shells`, by walks that use the smaller ones. Does not depend on the number of threads,
/// nor on how many there were before. What a mean over a shell's records is off by is about its walks' standard
/// deviation / sqrt(walks).
///
/// Returns the seconds that each took. Throws Cancelled, InputError.
std::vector<double> extend_stf(Stf& stf, size_t shells, const StfOptions& options, const Progress& progress);

} // namespace scree
