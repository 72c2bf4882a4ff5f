#pragma once

#include "render/bench/bench_job.h"
#include "render/bench/half_pictures.h"

#include <filesystem>
#include <string>

namespace scree {

class MethodRun;

/// The picture that others are held against, with its own noise.
struct ReferencePicture {
    HalfPictures picture;
    std::string name; ///< of how it was made, for people
    double processor_seconds = 0;
    uint64_t samples = 0; ///< a pixel; 0: not known
    std::string key; ///< of scene (its hash in 16 digits), method, seed and build, where it is a reference of ours
    std::string note; ///< what should be known about it; may be empty
};

/// Reads a picture of one's own: R G B, with halves where it is a reference of ours, or variance.R .G .B. Throws
/// InputError where it is of another size.
ReferencePicture read_reference(const std::filesystem::path& file, int width, int height);

/// Brings a reference to so many seconds of processors: one of the same scene, method, seed and build of the program
/// that lies in the file is gone on from; another one is kept beside it as *-before.exr, and said so. The method has
/// two pictures, the halves. The file is written about every half minute and when the work is cancelled, always with as
/// much of both halves. Throws InputError, Cancelled.
ReferencePicture render_reference(MethodRun& method, const std::filesystem::path& file, uint64_t seed,
                                  double processor_seconds, const Progress& progress);

} // namespace scree
