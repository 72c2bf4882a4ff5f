#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace scree {

/// An EXR as planes of 32-bit numbers, one for each channel, rows from the top, with its text and number attributes.
struct ExrPlanes {
    int width = 0, height = 0;
    std::map<std::string, std::vector<float>> planes;
    std::map<std::string, std::string> texts;
    std::map<std::string, double> numbers;
};

/// Writes the file whole or not at all. Throws InputError.
void write_exr_planes(const std::filesystem::path& path, const ExrPlanes& picture);

/// Reads every channel as float. Throws InputError when the file is no EXR, damaged or a crop.
ExrPlanes read_exr_planes(const std::filesystem::path& path);

} // namespace scree
