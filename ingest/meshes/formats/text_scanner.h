#pragma once

#include "base/error.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace scree::mesh_formats {

/// Reads a text word by word and counts its lines.
class TextScanner {
public:
    struct Syntax {
        bool comments = false; ///< '#' to the end of the line is skipped
        bool continuations = false; ///< a backslash at the end of a line joins the next
    };

    TextScanner(std::string_view text, std::string file, Syntax syntax)
        : rest_(text), file_(std::move(file)), syntax_(syntax)
    {
    }

    /// The next word on this line or a later one; empty at the end of the text.
    std::string_view word();

    /// The next word on this line; empty at its end.
    std::string_view word_in_line();

    /// Skips what is left of this line. False at the end of the text.
    bool next_line();

    uint64_t line() const { return line_; }
    std::string place() const { return file_ + ":" + std::to_string(line_); }
    const std::string& file() const { return file_; }

    /// The text that is not read yet.
    std::string_view rest() const { return rest_; }

    /// Parses word as a number. wanted: what the number is ("the x of a vertex"), for the InputError.
    double number(std::string_view word, const char* wanted) const;
    int64_t integer(std::string_view word, const char* wanted) const;

private:
    void skip_blanks();

    std::string_view rest_;
    std::string file_;
    Syntax syntax_;
    uint64_t line_ = 1;
};

/// A word of a file in quotes, for a message; "nothing" for an empty word.
std::string quoted(std::string_view word);

} // namespace scree::mesh_formats
