#pragma once

#include <string>
#include <vector>

namespace scree {

/// The rows as lines of text; columns are as wide as needed, the first is left-aligned and the others right-aligned.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

} // namespace scree
