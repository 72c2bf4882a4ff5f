#pragma once

#include "base/byte_source.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// One line of a text file, without its line end (LF or CRLF).
struct TextLine {
    std::string_view text;
    uint64_t number = 0; ///< from 1
    bool terminated = true; ///< false: the file ends without a line end, so the line may be cut off
};

/// Whole lines in one piece of memory; each ends with '\n', even if the file's last line has no line end.
struct LineBlock {
    std::string_view text;
    uint64_t first_line = 0; ///< number of the first line, from 1
    uint64_t lines = 0;
};

/// Consecutive blocks of lines.
struct LineBlocks {
    std::vector<LineBlock> blocks; ///< about 100 kB each, so that several threads can share the work
    uint64_t lines = 0; ///< in all blocks
    bool terminated = true; ///< false: the last line is the file's last and had no line end
};

/// Reads a file line by line, or many lines at once, with line numbers and bounded memory.
class LineReader {
public:
    /// The longest accepted line, in bytes; a file with a longer line is not a text file.
    static constexpr size_t longest_line = size_t{1} << 20;

    explicit LineReader(ByteSource source);

    /// The next line, or nothing at the end. The text is valid until the next call.
    /// Throws InputError when a line is longer than `longest_line`.
    std::optional<TextLine> next();

    /// The next lines, at most max_lines, before a line that begins with `stop`: as many as are in the buffer, and at
    /// least one unless such a line or the file's end comes next. Valid until the next call. Throws like `next`.
    LineBlocks next_block(uint64_t max_lines, std::string_view stop);

    /// Where the next line begins, in unpacked bytes.
    uint64_t offset() const { return offset_; }
    /// The number of the next line, from 1.
    uint64_t line() const { return line_; }

    /// Moves to `offset`, where line `line` begins; returns false when the file ends before it.
    /// A packed source can only move forward.
    bool skip_to(uint64_t offset, uint64_t line);

    const ByteSource& source() const { return source_; }
    ByteSource& source() { return source_; }

private:
    bool fill();
    void consume(size_t bytes, uint64_t lines);
    size_t find_line_end(bool& terminated);

    ByteSource source_;
    std::vector<char> buffer_;
    size_t begin_ = 0, end_ = 0; ///< the unread bytes in buffer_
    size_t chunk_;
    bool at_end_ = false;
    uint64_t offset_ = 0, line_ = 1;
};

} // namespace scree
