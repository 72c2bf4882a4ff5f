#pragma once

#include "base/progress.h"
#include "render/film/film.h"
#include "render/grains/library/grain_library.h"

namespace scree {

struct PortraitOptions {
    int size = 240; ///< width and height of the picture, pixels
    uint32_t spp = 128;
};

/// A picture of one grain of its typical size, lying on its flattest side on a grey floor under a soft sky and a low
/// sun, by explicit path tracing. Throws InputError naming `place`, and Cancelled.
Film render_portrait(const LibraryGrain& grain, const ShapeOptions& shape, const PortraitOptions& options,
                     const std::string& place, const Progress& progress);

} // namespace scree
