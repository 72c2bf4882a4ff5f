#include "base/byte_source.h"

#include "base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <vector>

namespace scree {

namespace {

constexpr size_t packed_buffer_size = size_t{1} << 18;

/// A "did you mean" hint from the names in a missing file's folder.
std::string near_names(const std::filesystem::path& path)
{
    std::vector<std::string> names;
    std::error_code ignored;
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    for (auto entry = std::filesystem::directory_iterator(folder, ignored);
         !ignored && entry != std::filesystem::directory_iterator() && names.size() < 1000; entry.increment(ignored))
        names.push_back(entry->path().filename().string());
    std::sort(names.begin(), names.end());
    std::string hint = did_you_mean(path.filename().string(), names);
    return hint.empty() ? hint : hint.substr(2);
}

/// Reads the bytes of a file as stored on disk.
class RawFile {
public:
    explicit RawFile(const std::filesystem::path& path) : path_(path)
    {
        descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
        if (descriptor_ < 0) {
            const int reason = errno;
            if (reason == ENOENT) throw InputError(path.string(), "no such file", "a file to read", near_names(path));
            throw InputError(path.string(), std::strerror(reason), "a file that can be read");
        }
        struct stat status {};
        if (::fstat(descriptor_, &status) == 0) {
            if (S_ISDIR(status.st_mode)) {
                ::close(descriptor_);
                throw InputError(path.string(), "a folder", "a file to read",
                                 "for one file per frame, give a pattern such as 'folder/*.dump'");
            }
            size_ = static_cast<uint64_t>(status.st_size);
        }
        ::posix_fadvise(descriptor_, 0, 0, POSIX_FADV_SEQUENTIAL);
    }
    ~RawFile() { ::close(descriptor_); }
    RawFile(const RawFile&) = delete;
    RawFile& operator=(const RawFile&) = delete;

    size_t read(char* out, size_t size)
    {
        size_t done = 0;
        while (done < size) {
            const ssize_t got = ::read(descriptor_, out + done, std::min(size - done, size_t{1} << 30));
            if (got < 0 && errno == EINTR) continue;
            if (got < 0) throw InputError(path_.string(), std::strerror(errno), "a file that can be read to its end");
            if (got == 0) break;
            done += static_cast<size_t>(got);
        }
        position_ += done;
        return done;
    }

    void seek(uint64_t offset)
    {
        if (::lseek(descriptor_, static_cast<off_t>(offset), SEEK_SET) < 0)
            throw InputError(path_.string(), std::strerror(errno), "a file that can be read from any position");
        position_ = offset;
    }

    double fraction() const { return size_ == 0 ? 1.0 : std::min(1.0, double(position_) / double(size_)); }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    uint64_t size_ = 0, position_ = 0;
};

/// Turns the bytes of a file into the bytes that a reader gets.
class Decoder {
public:
    virtual ~Decoder() = default;
    virtual size_t read(char* out, size_t size) = 0;
    virtual void seek(uint64_t) {}
    virtual bool seekable() const { return false; }
    virtual bool truncated() const { return false; }
    virtual double fraction() const = 0;
};

class PlainDecoder final : public Decoder {
public:
    PlainDecoder(std::unique_ptr<RawFile> file, std::string head) : file_(std::move(file)), head_(std::move(head)) {}
    size_t read(char* out, size_t size) override
    {
        // The bytes read to detect the format come first: a pipe cannot be rewound.
        const size_t from_head = std::min(size, head_.size() - head_used_);
        std::memcpy(out, head_.data() + head_used_, from_head);
        head_used_ += from_head;
        return from_head + (size > from_head ? file_->read(out + from_head, size - from_head) : 0);
    }
    void seek(uint64_t offset) override
    {
        head_used_ = head_.size();
        file_->seek(offset);
    }
    bool seekable() const override { return true; }
    double fraction() const override { return file_->fraction(); }

private:
    std::unique_ptr<RawFile> file_;
    std::string head_;
    size_t head_used_ = 0;
};

class MemoryDecoder final : public Decoder {
public:
    explicit MemoryDecoder(std::shared_ptr<const std::string> text) : text_(std::move(text)) {}
    size_t read(char* out, size_t size) override
    {
        const size_t count = std::min(size, text_->size() - position_);
        std::memcpy(out, text_->data() + position_, count);
        position_ += count;
        return count;
    }
    void seek(uint64_t offset) override { position_ = std::min<uint64_t>(offset, text_->size()); }
    bool seekable() const override { return true; }
    double fraction() const override { return text_->empty() ? 1.0 : double(position_) / double(text_->size()); }

private:
    std::shared_ptr<const std::string> text_;
    size_t position_ = 0;
};

/// Common part of the gzip and Zstandard decoders: a buffer of packed bytes.
class PackedDecoder : public Decoder {
public:
    PackedDecoder(std::unique_ptr<RawFile> file, const std::string& head)
        : file_(std::move(file)), buffer_(packed_buffer_size)
    {
        std::memcpy(buffer_.data(), head.data(), head.size());
        end_ = head.size();
    }
    bool truncated() const override { return truncated_; }
    double fraction() const override { return file_->fraction(); }

protected:
    /// Reads more packed bytes when the buffer is empty; returns whether any are left.
    bool refill()
    {
        if (begin_ < end_) return true;
        begin_ = 0;
        end_ = file_->read(buffer_.data(), buffer_.size());
        return end_ > 0;
    }
    [[noreturn]] void damaged(const char* kind, const char* why) const
    {
        throw InputError(file_->path().string(),
                         fmt::format("damaged {} data after {} unpacked bytes ({})", kind, unpacked_, why),
                         fmt::format("an intact {} file", kind), "copy or write the file again");
    }

    std::unique_ptr<RawFile> file_;
    std::vector<char> buffer_;
    size_t begin_ = 0, end_ = 0;
    uint64_t unpacked_ = 0;
    bool truncated_ = false, finished_ = false;
};

class GzipDecoder final : public PackedDecoder {
public:
    GzipDecoder(std::unique_ptr<RawFile> file, const std::string& head) : PackedDecoder(std::move(file), head)
    {
        if (inflateInit2(&stream_, 15 + 16) != Z_OK) throw std::bad_alloc();
    }
    ~GzipDecoder() override { inflateEnd(&stream_); }

    size_t read(char* out, size_t size) override
    {
        size_t done = 0;
        while (done < size && !finished_) {
            if (!refill()) {
                truncated_ = in_member_;
                finished_ = true;
                break;
            }
            if (!in_member_ && !start_member()) break;
            const size_t room = std::min(size - done, size_t{1} << 30);
            stream_.next_in = reinterpret_cast<Bytef*>(buffer_.data() + begin_);
            stream_.avail_in = static_cast<uInt>(end_ - begin_);
            stream_.next_out = reinterpret_cast<Bytef*>(out + done);
            stream_.avail_out = static_cast<uInt>(room);
            const int code = inflate(&stream_, Z_NO_FLUSH);
            begin_ = end_ - stream_.avail_in;
            const size_t got = room - stream_.avail_out;
            done += got;
            unpacked_ += got;
            if (code == Z_STREAM_END)
                in_member_ = false;
            else if (code != Z_OK && code != Z_BUF_ERROR)
                damaged("gzip", stream_.msg ? stream_.msg : "unknown");
        }
        return done;
    }

private:
    /// Handles the bytes after a member: another member, padding with zeros (as tapes leave it), or foreign bytes.
    bool start_member()
    {
        if (members_ > 0 && buffer_[begin_] == 0) {
            do {
                while (begin_ < end_ && buffer_[begin_] == 0) ++begin_;
            } while (begin_ == end_ && refill());
            if (begin_ == end_) {
                finished_ = true;
                return false;
            }
        }
        if (static_cast<unsigned char>(buffer_[begin_]) != 0x1f) damaged("gzip", "foreign bytes after a member");
        inflateReset(&stream_);
        in_member_ = true;
        ++members_;
        return true;
    }

    z_stream stream_{};
    bool in_member_ = false;
    uint64_t members_ = 0;
};

class ZstdDecoder final : public PackedDecoder {
public:
    ZstdDecoder(std::unique_ptr<RawFile> file, const std::string& head)
        : PackedDecoder(std::move(file), head), stream_(ZSTD_createDStream(), &ZSTD_freeDStream)
    {
        if (!stream_) throw std::bad_alloc();
    }

    size_t read(char* out, size_t size) override
    {
        size_t done = 0;
        while (done < size && !finished_) {
            // The decoder may still hold output when there is no new input, so it is called even at the file's end.
            const bool more = refill();
            ZSTD_inBuffer input{buffer_.data(), end_, begin_};
            ZSTD_outBuffer output{out, size, done};
            const size_t code = ZSTD_decompressStream(stream_.get(), &output, &input);
            if (ZSTD_isError(code)) damaged("Zstandard", ZSTD_getErrorName(code));
            begin_ = input.pos;
            const size_t got = output.pos - done;
            done += got;
            unpacked_ += got;
            if (more || got > 0) in_frame_ = code != 0;
            if (!more && got == 0) {
                truncated_ = in_frame_;
                finished_ = true;
            }
        }
        return done;
    }

private:
    std::unique_ptr<ZSTD_DStream, size_t (*)(ZSTD_DStream*)> stream_;
    bool in_frame_ = false;
};

bool starts_with(const std::string& head, std::string_view magic) { return head.compare(0, magic.size(), magic) == 0; }

std::unique_ptr<Decoder> decoder_for(const std::filesystem::path& path)
{
    auto file = std::make_unique<RawFile>(path);
    std::string head(8, '\0');
    head.resize(file->read(head.data(), head.size()));

    if (starts_with(head, "\x1f\x8b")) return std::make_unique<GzipDecoder>(std::move(file), head);
    const bool skippable = head.size() >= 4 && (head[0] & 0xf0) == 0x50 && head.compare(1, 3, "\x2a\x4d\x18") == 0;
    if (starts_with(head, "\x28\xb5\x2f\xfd") || skippable) return std::make_unique<ZstdDecoder>(std::move(file), head);

    static constexpr std::array<std::pair<std::string_view, const char*>, 5> foreign{{{"BZh", "bzip2"},
                                                                                      {std::string_view("\xfd"
                                                                                                        "7zXZ\0",
                                                                                                        6),
                                                                                       "xz"},
                                                                                      {"PK\x03\x04", "zip"},
                                                                                      {"\x04\x22\x4d\x18", "lz4"},
                                                                                      {"\x1f\x9d", "compress (.Z)"}}};
    for (const auto& [magic, kind] : foreign)
        if (starts_with(head, magic))
            throw InputError(path.string(), fmt::format("a file packed with {}", kind), "plain text, gzip or Zstandard",
                             "unpack it, or pack it with gzip or zstd");
    return std::make_unique<PlainDecoder>(std::move(file), head);
}

} // namespace

struct ByteSource::Impl {
    std::filesystem::path path;
    std::unique_ptr<Decoder> decoder;
    std::shared_ptr<std::string> kept;
    size_t keep_limit = 0;
};

ByteSource::ByteSource(const std::filesystem::path& path) : impl_(std::make_unique<Impl>())
{
    impl_->path = path;
    impl_->decoder = decoder_for(path);
}

ByteSource::ByteSource(std::filesystem::path path, std::shared_ptr<const std::string> text)
    : impl_(std::make_unique<Impl>())
{
    impl_->path = std::move(path);
    impl_->decoder = std::make_unique<MemoryDecoder>(std::move(text));
}

ByteSource::~ByteSource() = default;
ByteSource::ByteSource(ByteSource&&) noexcept = default;
ByteSource& ByteSource::operator=(ByteSource&&) noexcept = default;

size_t ByteSource::read(char* out, size_t size)
{
    const size_t got = impl_->decoder->read(out, size);
    if (impl_->kept) {
        if (impl_->kept->size() + got > impl_->keep_limit)
            impl_->kept.reset();
        else
            impl_->kept->append(out, got);
    }
    return got;
}

void ByteSource::seek(uint64_t offset) { impl_->decoder->seek(offset); }
bool ByteSource::seekable() const { return impl_->decoder->seekable(); }
bool ByteSource::truncated() const { return impl_->decoder->truncated(); }
double ByteSource::fraction() const { return impl_->decoder->fraction(); }
const std::filesystem::path& ByteSource::path() const { return impl_->path; }

void ByteSource::keep(size_t limit)
{
    impl_->keep_limit = limit;
    impl_->kept = std::make_shared<std::string>();
}

std::shared_ptr<const std::string> ByteSource::kept() const { return impl_->kept; }

} // namespace scree
