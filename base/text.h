#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// Text from a file, in a form for messages: in quotes, cut to about 60 characters, unprintable bytes as \xNN.
std::string in_quotes(std::string_view text);

/// The words of a line, which blanks separate.
std::vector<std::string_view> split_words(std::string_view line);

/// The words joined by ", ".
std::string join_words(const std::vector<std::string>& words);

/// The word with 'A'..'Z' replaced by 'a'..'z'.
std::string lower_case(std::string_view word);

/// The whole word as a number, or nothing; infinities and NaN count as numbers here.
std::optional<double> to_double(std::string_view word);

/// The whole word as an integer, or nothing; "3.0" and "1e6" are integers too, as some programs write them.
std::optional<int64_t> to_int64(std::string_view word);

} // namespace scree
