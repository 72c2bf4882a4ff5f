#include "base/line_reader.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace scree {

namespace {

// Small at first, so that a thousand short frames do not each read megabytes.
constexpr size_t first_chunk = size_t{1} << 16;
constexpr size_t largest_chunk = size_t{1} << 22;
constexpr size_t block_size = size_t{1} << 17;

} // namespace

LineReader::LineReader(ByteSource source) : source_(std::move(source)), chunk_(first_chunk) {}

bool LineReader::fill()
{
    if (at_end_) return false;
    const size_t held = end_ - begin_;
    if (begin_ > 0) std::memmove(buffer_.data(), buffer_.data() + begin_, held);
    begin_ = 0;
    end_ = held;
    const size_t wanted = std::max(chunk_, 2 * held);
    // One byte more, for the line end that the last line may lack.
    if (buffer_.size() < wanted + 1) buffer_.resize(wanted + 1);
    const size_t got = source_.read(buffer_.data() + end_, wanted - held);
    at_end_ = got < wanted - held;
    end_ += got;
    chunk_ = std::min(2 * chunk_, largest_chunk);
    return got > 0;
}

void LineReader::consume(size_t bytes, uint64_t lines)
{
    begin_ += bytes;
    offset_ += bytes;
    line_ += lines;
}

/// Number of bytes of the next line with its line end; 0 when there is no line left.
size_t LineReader::find_line_end(bool& terminated)
{
    terminated = true;
    size_t looked_at = 0;
    for (;;) {
        const size_t held = end_ - begin_;
        if (held > looked_at) {
            const char* start = buffer_.data() + begin_;
            if (const void* found = std::memchr(start + looked_at, '\n', held - looked_at))
                return static_cast<size_t>(static_cast<const char*>(found) - start) + 1;
        }
        looked_at = held;
        if (held > longest_line)
            throw InputError(fmt::format("{}:{}", source_.path().string(), line_),
                             fmt::format("a line of more than {} bytes", longest_line), "lines of text",
                             "is this a text file?");
        if (!fill()) {
            terminated = false;
            return held;
        }
    }
}

std::optional<TextLine> LineReader::next()
{
    TextLine line;
    const size_t bytes = find_line_end(line.terminated);
    if (bytes == 0) return std::nullopt;
    line.text = std::string_view(buffer_.data() + begin_, bytes - (line.terminated ? 1 : 0));
    if (line.text.ends_with('\r')) line.text.remove_suffix(1);
    line.number = line_;
    consume(bytes, 1);
    return line;
}

LineBlocks LineReader::next_block(uint64_t max_lines, std::string_view stop)
{
    LineBlocks result;
    if (max_lines == 0) return result;
    if (end_ - begin_ < chunk_ / 2) fill();

    const size_t first = find_line_end(result.terminated);
    if (first == 0) return result;
    // An unterminated line is the file's last, so nothing follows it in the buffer.
    if (!result.terminated) buffer_[end_++] = '\n';

    const char* p = buffer_.data() + begin_;
    const char* const end = buffer_.data() + end_;
    const char* block_begin = p;
    uint64_t block_lines = 0;
    const auto close_block = [&] {
        if (block_lines == 0) return;
        const size_t bytes = static_cast<size_t>(p - block_begin);
        result.blocks.push_back({{block_begin, bytes}, line_, block_lines});
        consume(bytes, block_lines);
        block_begin = p;
        block_lines = 0;
    };
    while (p < end && result.lines < max_lines) {
        if (*p == stop[0] && std::string_view(p, static_cast<size_t>(end - p)).starts_with(stop)) break;
        const void* found = std::memchr(p, '\n', static_cast<size_t>(end - p));
        if (!found) break;
        p = static_cast<const char*>(found) + 1;
        ++block_lines;
        ++result.lines;
        if (static_cast<size_t>(p - block_begin) >= block_size) close_block();
    }
    close_block();
    if (result.lines == 0) {
        if (!result.terminated) --end_;
        result.terminated = true;
    }
    return result;
}

bool LineReader::skip_to(uint64_t offset, uint64_t line)
{
    if (offset >= offset_ && offset - offset_ <= end_ - begin_) {
        begin_ += static_cast<size_t>(offset - offset_);
    } else if (source_.seekable()) {
        source_.seek(offset);
        begin_ = end_ = 0;
        at_end_ = false;
        chunk_ = first_chunk;
    } else {
        uint64_t position = offset_ + (end_ - begin_);
        begin_ = end_ = 0;
        while (position < offset) {
            buffer_.resize(std::max(buffer_.size(), largest_chunk + 1));
            const size_t wanted = static_cast<size_t>(std::min<uint64_t>(offset - position, largest_chunk));
            const size_t got = source_.read(buffer_.data(), wanted);
            position += got;
            if (got < wanted) return false;
        }
    }
    offset_ = offset;
    line_ = line;
    return true;
}

} // namespace scree
