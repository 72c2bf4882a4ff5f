#include "base/error.h"

#include <algorithm>
#include <numeric>

namespace scree {

namespace {

std::string message(const std::string& place, const std::string& found, const std::string& expected,
                    const std::string& hint)
{
    std::string text = place + ": found " + found + ", expected " + expected;
    if (!hint.empty()) text += " (" + hint + ")";
    return text;
}

/// Levenshtein distance.
size_t edit_distance(const std::string& a, const std::string& b)
{
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t substitute = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
        }
    }
    return row.back();
}

} // namespace

InputError::InputError(std::string place, std::string found, std::string expected, std::string hint)
    : std::runtime_error(message(place, found, expected, hint)), place_(std::move(place)), found_(std::move(found)),
      expected_(std::move(expected)), hint_(std::move(hint))
{
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates)
{
    const std::string* best = nullptr;
    size_t best_distance = std::max<size_t>(2, word.size() / 2) + 1;
    for (const std::string& candidate : candidates) {
        const size_t distance = edit_distance(word, candidate);
        if (distance < best_distance) {
            best_distance = distance;
            best = &candidate;
        }
    }
    return best ? ", did you mean '" + *best + "'?" : "";
}

} // namespace scree
