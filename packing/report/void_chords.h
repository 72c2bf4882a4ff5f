#pragma once

#include "base/progress.h"
#include "packing/report/packed_spheres.h"
#include "packing/report/pair_correlation.h"
#include "packing/report/solid_fraction.h"

#include <vector>

namespace scree {

/// Chords of the voids between the spheres along uniform isotropic random lines.
///
/// The mean is (length in voids) / (number of entries into spheres) over pieces of lines that are chosen independently
/// of the spheres. The expectations of both are proportional to the length, so chords that are cut by the ends of the
/// pieces cause no bias.
struct VoidChords {
    uint64_t lines = 0; ///< 0: there is no bulk to draw lines in
    uint64_t entries = 0;
    double length = 0; ///< total length of the lines
    Measured mean; ///< the error follows from the scatter between lines
    double expected = 0; ///< 4 (1 - f) <r^3> / (3 f <r^2>), with the bulk's fraction and spheres
    double expected_error = 0; ///< from the error of the fraction, if that was measured by points
    double solid_part = 0; ///< part of the lines' length that lies in spheres

    /// Probability density times the mean, of complete chords that start well before the end of their line, in bins of
    /// 0.1 of the mean.
    static constexpr double bin_width = 0.1;
    std::vector<double> density;
    uint64_t chords = 0;
};

/// Measures chords in the bulk. Throws Cancelled.
VoidChords measure_void_chords(const PackedSpheres& spheres, const SolidFraction& fraction,
                               const Progress& progress = {});

} // namespace scree
