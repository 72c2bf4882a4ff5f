#pragma once

#include <filesystem>

namespace scree {

/// The folder of the running program; empty when the system does not provide it.
std::filesystem::path folder_of_this_program();

} // namespace scree
