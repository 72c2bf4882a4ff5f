#pragma once

#include "render/bench/bench_job.h"
#include "render/bench/error_estimate.h"
#include "render/bench/machine.h"
#include "render/bench/method_run.h"
#include "render/bench/reference_picture.h"

#include <optional>
#include <string>
#include <vector>

namespace scree {

/// How far a method was after some time: means over its pictures, each of another seed.
struct ConvergencePoint {
    WorkTime time; ///< of one picture
    double samples = 0; ///< a pixel, of one picture
    Measured squared_error; ///< relative, against the truth
    bool below_reference = false;
};

struct MethodResult {
    std::string name, plan;
    SetupTime setup;
    uint64_t memory = 0; ///< bytes at the peak of its set-up
    uint64_t grains = 0;
    std::vector<std::string> warnings;
    WorkTime time; ///< of all its pictures
    uint64_t samples = 0; ///< a pixel, of all its pictures
    RenderStatistics statistics;
    std::vector<ConvergencePoint> points;
    ErrorEstimate estimate; ///< of all its pictures together
    HalfPictures picture;
    std::vector<double> flip; ///< against the reference

    /// Seconds of processors until the relative variance of the picture is 1, without set-up.
    double time_to_unit_variance() const { return estimate.noise.value * time.processor; }
};

/// All that one run of `scree bench` found out about a scene.
struct BenchResult {
    BenchJob job;
    uint64_t scene_hash = 0;
    Machine machine;
    ReferencePicture reference;
    Measured reference_noise; ///< squared, relative; of infinite error where it is not known
    double reference_flip = 0; ///< mean, of its two halves
    std::vector<MethodResult> methods;
    std::vector<std::string> notes;
    uint64_t peak_memory = 0; ///< of the program

    int width() const { return reference.picture.width; }
    int height() const { return reference.picture.height; }
    /// How many times less processor time of rendering, without set-up, a method takes than ept to the same variance;
    /// nothing without ept. Of infinite standard error where a noise is not known.
    std::optional<Measured> gain(const MethodResult& method) const;
    /// Part of its threads' time in which rendering had a processor: well below 1 on a busy machine.
    double processor_share() const;
};

} // namespace scree
