#pragma once

#include "render/bench/bench_job.h"
#include "render/bench/half_pictures.h"

#include <filesystem>
#include <string>

namespace scree {

class MethodRun;

/// The picture that others are compared with, and its own noise.
struct ReferencePicture {
    HalfPictures picture;
    std::string name; ///< of the method that made it, or of its file; for people
    double processor_seconds = 0;
    uint64_t samples = 0; ///< a pixel; 0: not known
    std::string key; ///< scene (its hash in 16 digits), method, seed and build, if `scree bench` rendered it
    std::string note; ///< for the user; may be empty
};

/// Reads a picture that the user gives: R G B, optionally with halves (if `scree bench` rendered it) or with variance.R
/// .G .B. Throws InputError if it has another size.
ReferencePicture read_reference(const std::filesystem::path& file, int width, int height);

/// Renders a reference to `processor_seconds` in all, or continues the one in the file.
///
/// A reference in the file is continued if it has the same scene, method, seed and build; any other is moved to
/// *-before.exr, and a note says so. The method has two pictures, the halves. The file is written about every half
/// minute and on cancellation, always with equally much of both halves. Throws InputError, Cancelled.
ReferencePicture render_reference(MethodRun& method, const std::filesystem::path& file, uint64_t seed,
                                  double processor_seconds, const Progress& progress);

} // namespace scree
