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

/// The error of a method after some time: means over its pictures, each with its own seed.
struct ConvergencePoint {
    WorkTime time; ///< of one picture
    double samples = 0; ///< a pixel, of one picture
    Measured squared_error; ///< relative, against the truth
    bool below_reference = false;
};

struct MethodResult {
    std::string name, plan;
    SetupTime setup;
    uint64_t memory = 0; ///< peak bytes of its set-up, minus those used before it
    uint64_t grains = 0;
    std::vector<std::string> warnings;
    WorkTime time; ///< of all its pictures
    uint64_t samples = 0; ///< a pixel, of all its pictures
    RenderStatistics statistics;
    std::vector<ConvergencePoint> points;
    ErrorEstimate estimate; ///< of all its pictures together
    HalfPictures picture;
    std::vector<double> flip; ///< against the reference

    /// Processor seconds of rendering, without set-up, until the relative variance of the picture is 1 (TTUV).
    double time_to_unit_variance() const { return estimate.noise.value * time.processor; }
};

/// The results of one run of `scree bench` on a scene.
struct BenchResult {
    BenchJob job;
    uint64_t scene_hash = 0;
    Machine machine;
    ReferencePicture reference;
    Measured reference_noise; ///< relative variance; its standard error is infinite if the noise is not known
    double reference_flip = 0; ///< mean FLIP between the reference's two halves
    std::vector<MethodResult> methods;
    std::vector<std::string> notes;
    uint64_t peak_memory = 0; ///< bytes, of the whole program

    int width() const { return reference.picture.width; }
    int height() const { return reference.picture.height; }
    /// How many times faster than ept a method reaches the same variance, by processor time without set-up. Nothing
    /// without ept; the standard error is infinite if the noise of one of them is not known.
    std::optional<Measured> gain(const MethodResult& method) const;
    /// Processor time of rendering over wall time times threads: well below 1 on a busy machine.
    double processor_share() const;
};

} // namespace scree
