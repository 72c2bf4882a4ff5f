#include "base/text.h"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace scree {

namespace {

bool is_blank(char c) { return static_cast<unsigned char>(c) <= ' '; }

} // namespace

std::string in_quotes(std::string_view text)
{
    constexpr size_t longest = 60;
    std::string result = "'";
    for (const char c : text.substr(0, longest)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte >= 0x7f)
            result += fmt::format("\\x{:02x}", byte);
        else
            result += c;
    }
    return result + (text.size() > longest ? "...'" : "'");
}

std::vector<std::string_view> split_words(std::string_view line)
{
    std::vector<std::string_view> words;
    size_t i = 0;
    while (i < line.size()) {
        while (i < line.size() && is_blank(line[i])) ++i;
        const size_t start = i;
        while (i < line.size() && !is_blank(line[i])) ++i;
        if (i > start) words.push_back(line.substr(start, i - start));
    }
    return words;
}

std::string join_words(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

std::string lower_case(std::string_view word)
{
    std::string result(word);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

std::optional<double> to_double(std::string_view word)
{
    const char* first = word.data();
    const char* last = first + word.size();
    if (first != last && *first == '+') ++first;
    double value = 0;
    const auto [end, error] = fast_float::from_chars(first, last, value);
    if (error != std::errc() || end != last || first == last) return std::nullopt;
    return value;
}

std::optional<int64_t> to_int64(std::string_view word)
{
    const char* first = word.data();
    const char* last = first + word.size();
    if (first != last && *first == '+') ++first;
    int64_t value = 0;
    const auto [end, error] = std::from_chars(first, last, value);
    if (error == std::errc() && end == last) return value;
    const std::optional<double> real = to_double(word);
    if (!real || std::trunc(*real) != *real || std::abs(*real) > 9007199254740992.0) return std::nullopt;
    return static_cast<int64_t>(*real);
}

} // namespace scree
