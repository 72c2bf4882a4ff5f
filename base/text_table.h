#pragma once

#include <string>
#include <vector>

namespace scree {

/// Rows as lines of text, columns as wide as they need to be, the first to the left and the others to the right.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

} // namespace scree
