#pragma once

#include "base/progress.h"
#include "render/stf/stf.h"

namespace scree {

struct StfOptions {
    uint64_t walks = uint64_t{1} << 17; ///< per shell, that scatter; 2^10 .. 2^24
    uint32_t records = uint32_t{1} << 15; ///< kept per shell of exits and of scatterings each, 2^6 .. 2^20
    uint64_t seed = 1;
};

/// Adds shells until there are `shells`, by walks that use the smaller shells.
///
/// The result depends neither on the number of threads nor on how many shells there were before. The error of a mean
/// over a shell's records is about the walks' standard deviation / sqrt(walks). Returns the seconds that each new shell
/// took. Throws Cancelled, InputError.
std::vector<double> extend_stf(Stf& stf, size_t shells, const StfOptions& options, const Progress& progress);

} // namespace scree
