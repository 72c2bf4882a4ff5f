#pragma once

#include "base/progress.h"
#include "packing/report/packed_spheres.h"
#include "packing/report/pair_correlation.h"
#include "packing/report/solid_fraction.h"

#include <vector>

namespace scree {

/// Chords of the voids between the spheres along uniform isotropic random lines.
///
/// The mean is (void length) / (number of times a line enters a sphere) over pieces of lines chosen without regard to
/// the spheres: both have expectations proportional to the length, so that the ends of the pieces, which cut chords, do
/// no harm.
struct VoidChords {
    uint64_t lines = 0; ///< 0: there is no bulk to draw lines in
    uint64_t entries = 0;
    double length = 0; ///< of the lines, in all
    Measured mean; ///< error from the scatter between lines
    double expected = 0; ///< 4 (1 - f) <r^3> / (3 f <r^2>) of the bulk, its fraction and its spheres
    double expected_error = 0; ///< from the fraction's error, where that was measured by points
    double solid_part = 0; ///< of the lines' length

    /// Density of whole chords that start well before their line's end, in bins of 0.1 of the mean; of probability
    /// times mean.
    static constexpr double bin_width = 0.1;
    std::vector<double> density;
    uint64_t chords = 0;
};

/// Throws Cancelled.
VoidChords measure_void_chords(const PackedSpheres& spheres, const SolidFraction& fraction,
                               const Progress& progress = {});

} // namespace scree
