#include "base/atomic_file.h"

#include "base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace scree {

AtomicFile::AtomicFile(std::filesystem::path target) : target_(std::move(target))
{
    std::error_code ignored;
    if (target_.filename().empty() || std::filesystem::is_directory(target_, ignored))
        throw InputError(target_.string(), "a folder", "the name of a file to write");
    const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
    if (!std::filesystem::is_directory(folder, ignored))
        throw InputError(target_.string(), fmt::format("no folder '{}'", folder.string()), "a folder that exists",
                         "make the folder first");

    // The process id and a counter make the name unique; O_EXCL guarantees it.
    static std::atomic<unsigned> counter{0};
    for (int attempt = 0; attempt < 100; ++attempt) {
        temporary_ = folder / fmt::format(".{}.{}-{}.tmp{}", target_.stem().string(), ::getpid(), counter++,
                                          target_.extension().string());
        const int descriptor = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            ::close(descriptor);
            return;
        }
        if (errno != EEXIST) break;
    }
    throw InputError(target_.string(), std::strerror(errno), "a folder that can be written to");
}

AtomicFile::~AtomicFile()
{
    std::error_code ignored;
    if (!committed_) std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit()
{
    // The data must be on disk before the rename: otherwise a crash can leave half a file under the final name.
    const int descriptor = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor >= 0) {
        ::fsync(descriptor);
        ::close(descriptor);
    }
    std::error_code failure;
    std::filesystem::rename(temporary_, target_, failure);
    if (failure) throw InputError(target_.string(), failure.message(), "a place where a file can be written");
    committed_ = true;
}

void write_whole(const std::filesystem::path& path, std::string_view text)
{
    AtomicFile file(path);
    std::ofstream out(file.temporary(), std::ios::binary);
    out << text;
    out.close();
    if (!out) throw InputError(path.string(), "a file that cannot be written in full", "enough free space on the disk");
    file.commit();
}

} // namespace scree
