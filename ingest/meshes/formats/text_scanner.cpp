#include "ingest/meshes/formats/text_scanner.h"

#include "base/text.h"

#include <algorithm>

namespace scree::mesh_formats {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

} // namespace

std::string quoted(std::string_view word) { return word.empty() ? "nothing" : in_quotes(word); }

void TextScanner::skip_blanks()
{
    while (!rest_.empty()) {
        if (is_blank(rest_[0])) {
            rest_.remove_prefix(1);
        } else if (syntax_.comments && rest_[0] == '#') {
            rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
        } else if (syntax_.continuations && (rest_.starts_with("\\\n") || rest_.starts_with("\\\r\n"))) {
            rest_.remove_prefix(rest_.find('\n') + 1);
            ++line_;
        } else {
            return;
        }
    }
}

std::string_view TextScanner::word_in_line()
{
    skip_blanks();
    size_t length = 0;
    while (length < rest_.size()) {
        const char c = rest_[length];
        if (c == '\n' || is_blank(c) || (syntax_.comments && c == '#')) break;
        if (syntax_.continuations && c == '\\' &&
            (rest_.substr(length).starts_with("\\\n") || rest_.substr(length).starts_with("\\\r\n"))) {
            break;
        }
        ++length;
    }
    const std::string_view word = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return word;
}

std::string_view TextScanner::word()
{
    for (;;) {
        const std::string_view found = word_in_line();
        if (!found.empty() || !next_line()) return found;
    }
}

bool TextScanner::next_line()
{
    const size_t end = rest_.find('\n');
    if (end == std::string_view::npos) {
        rest_ = {};
        return false;
    }
    rest_.remove_prefix(end + 1);
    ++line_;
    return true;
}

double TextScanner::number(std::string_view word, const char* wanted) const
{
    if (const std::optional<double> value = to_double(word)) return *value;
    throw InputError(place(), quoted(word), std::string("a number, ") + wanted);
}

int64_t TextScanner::integer(std::string_view word, const char* wanted) const
{
    if (const std::optional<int64_t> value = to_int64(word)) return *value;
    throw InputError(place(), quoted(word), std::string("a whole number, ") + wanted);
}

} // namespace scree::mesh_formats
