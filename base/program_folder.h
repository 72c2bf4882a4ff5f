#pragma once

#include <filesystem>

namespace scree {

/// The folder of the running program; empty when the system does not tell.
std::filesystem::path folder_of_this_program();

} // namespace scree
