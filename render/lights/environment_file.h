#pragma once

#include "render/lights/environment_map.h"

#include <filesystem>

namespace scree {

/// Reads a latitude-longitude picture (EXR, HDR, PNG, ... through OpenImageIO; 8-bit files are taken as sRGB).
/// Throws InputError when it cannot be read or holds a texel that is not finite or below zero.
EnvironmentMap read_environment(const std::filesystem::path& file, const V3d& up, const Color& scale);

} // namespace scree
