#pragma once

#include "render/film/aov.h"
#include "render/film/film.h"

#include <Imath/ImathMatrix.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace scree {

/// What an EXR says about how it was made.
struct PictureMetadata {
    std::map<std::string, std::string> texts; ///< EXR string attributes
    std::map<std::string, double> numbers; ///< EXR float attributes
    Imath::M44d world_to_camera, world_to_ndc;
    double depth_scale = 1; ///< from render coordinates to the scene's unit
};

/// Writes the picture as an EXR of scan lines; the file appears whole or not at all. Throws InputError.
///
/// Channels of 32-bit floats: R G B, and per AOV albedo.R .G .B, N.X .Y .Z, Z (0 where nothing was hit),
/// variance.R .G .B (of the pixel's mean). Channels of 32-bit integers: type, id (4294967295 where there is no grain),
/// samples. The data window is the rendered part.
void write_exr(const std::filesystem::path& path, const Film& film, const std::vector<Aov>& aov,
               const PictureMetadata& metadata);

/// Writes an 8-bit sRGB picture for viewing (PNG, JPEG, ... by the extension), clipped at white = 1.
void write_preview(const std::filesystem::path& path, const Film& film);

/// Throws InputError when write_preview knows no format of this extension.
void check_preview_format(const std::filesystem::path& path);

} // namespace scree
