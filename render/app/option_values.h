#pragma once

#include <string>
#include <utility>

namespace scree {

// Values of options that several commands have; each throws InputError that names the option.

/// --size WIDTHxHEIGHT, 1 to 65536 pixels each.
std::pair<int, int> parse_picture_size(const std::string& text);

/// -D key=value: a path in the scene and JSON.
std::pair<std::string, std::string> parse_override(const std::string& text);

} // namespace scree
