#pragma once

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace scree {

/// The word for each value of an enum, as it stands in scene files, on the command line and in reports.
template <class E>
class EnumNames {
public:
    using Row = std::pair<E, std::string>;

    EnumNames(std::initializer_list<Row> rows) : rows_(rows) {}
    explicit EnumNames(std::vector<Row> rows) : rows_(std::move(rows)) {}

    /// Empty for a value that has no word.
    const std::string& operator[](E value) const
    {
        static const std::string none;
        const auto row = std::ranges::find(rows_, value, &Row::first);
        return row == rows_.end() ? none : row->second;
    }
    std::optional<E> find(const std::string& word) const
    {
        const auto row = std::ranges::find(rows_, word, &Row::second);
        return row == rows_.end() ? std::nullopt : std::optional(row->first);
    }
    std::vector<std::string> words() const
    {
        std::vector<std::string> words;
        for (const Row& row : rows_) words.push_back(row.second);
        return words;
    }
    auto begin() const { return rows_.begin(); }
    auto end() const { return rows_.end(); }

private:
    std::vector<Row> rows_;
};

} // namespace scree
