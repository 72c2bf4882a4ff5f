#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace scree {

/// Contents of a picture file: rows from the top, `channels` values per pixel; values of 8-bit files are 0 to 1 and not
/// converted to linear light.
struct PictureFile {
    size_t width = 0, height = 0, channels = 0;
    size_t full_width = 0, full_height = 0; ///< of the picture before it was cropped
    bool whole = true; ///< nothing was cropped off
    bool eight_bit = false;
    std::vector<float> values; ///< empty when not whole
};

// These functions use OpenImageIO. Loading it takes longer than many whole commands, so the first call loads it. Every
// function throws InputError when it cannot be loaded.

/// Reads a picture (EXR, HDR, PNG, ...). Throws InputError when it cannot be read.
PictureFile read_picture_file(const std::filesystem::path& path);

/// Whether write_picture_file knows the format of this extension.
bool can_write_picture_file(const std::filesystem::path& path);

/// The bytes of the file that write_picture_file would write under this name. Throws InputError.
std::string encode_picture(const std::filesystem::path& name, int width, int height, std::span<const float> rgb);

/// Writes an RGB picture (PNG, JPEG, ... by the extension), 8-bit where the format supports it; rgb: 3 width height
/// values, 0 to 1, encoded for a screen. The file appears whole or not at all. Throws InputError.
void write_picture_file(const std::filesystem::path& path, int width, int height, std::span<const float> rgb);

} // namespace scree
