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
    bool terminated = true; ///< false: the file ends where the line does, so that the line may be cut
};

/// Whole lines in one piece of memory; each ends with '\n', also when the file's last line does not.
struct LineBlock {
    std::string_view text;
    uint64_t first_line = 0; ///< number of the first line, from 1
    uint64_t lines = 0;
};

/// Consecutive blocks of lines.
struct LineBlocks {
    std::vector<LineBlock> blocks; ///< of some 100 kB each: work for several threads
    uint64_t lines = 0; ///< in all
    bool terminated = true; ///< false: the last line is the file's last and had no line end
};

/// A file line by line, or by many lines at once, with line numbers and bounded memory.
class LineReader {
public:
    /// What can stand in one line; a file with a longer one is no text file.
    static constexpr size_t longest_line = size_t{1} << 20;

    explicit LineReader(ByteSource source);

    /// The next line, or nothing at the end. The text is valid until the next call.
    /// Throws InputError when a line is longer than `longest_line`.
    std::optional<TextLine> next();

    /// Up to max_lines of the lines that follow: as many as are at hand, and at least one, unless the file ends or
    /// a line that begins with `stop` comes. Valid until the next call. Throws InputError as `next` does.
    LineBlocks next_block(uint64_t max_lines, std::string_view stop);

    /// Where the next line begins, in unpacked bytes.
    uint64_t offset() const { return offset_; }
    /// The number of the next line, from 1.
    uint64_t line() const { return line_; }

    /// Goes on to `offset`, which is where line `line` begins; returns false when the file ends before it.
    /// Only forward when the source is packed.
    bool skip_to(uint64_t offset, uint64_t line);

    const ByteSource& source() const { return source_; }
    ByteSource& source() { return source_; }

private:
    bool fill();
    void consume(size_t bytes, uint64_t lines);
    size_t find_line_end(bool& terminated);

    ByteSource source_;
    std::vector<char> buffer_;
    size_t begin_ = 0, end_ = 0; ///< the bytes at hand
    size_t chunk_;
    bool at_end_ = false;
    uint64_t offset_ = 0, line_ = 1;
};

} // namespace scree
