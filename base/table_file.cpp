#include "base/table_file.h"

#include "base/atomic_file.h"

#include <bit>

namespace scree {

static_assert(std::endian::native == std::endian::little, "numbers in the files are little-endian");

void TableFileWriter::write() const
{
    AtomicFile output(file_);
    std::ofstream stream(output.temporary(), std::ios::binary);
    for (const Part& part : parts_)
        stream.write(static_cast<const char*>(part.bytes), static_cast<std::streamsize>(part.size));
    stream.close();
    if (!stream) throw InputError(file_.string(), "a file that cannot be written", "enough free space for " + what_);
    output.commit();
}

TableFileReader::TableFileReader(const std::filesystem::path& file, std::string what)
    : file_(file), what_(std::move(what)), stream_(file, std::ios::binary | std::ios::ate)
{
    if (!stream_) throw refuse("a file that cannot be read");
    left_ = static_cast<uint64_t>(stream_.tellg());
    stream_.seekg(0);
}

void TableFileReader::read(void* bytes, uint64_t size)
{
    if (size > left_ || !stream_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(size)))
        throw refuse("a file that ends early");
    left_ -= size;
}

InputError TableFileReader::refuse(const std::string& found) const
{
    return InputError(file_.string(), found, what_ + " written by this version of Scree",
                      "remove it; Scree will make it again");
}

void TableFileReader::finish(uint64_t checksum, uint64_t expected) const
{
    if (left_ != 0) throw refuse("a file of the wrong length");
    if (checksum != expected) throw refuse("a damaged file: its checksum is wrong");
}

} // namespace scree
