#pragma once

#include "base/error.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

namespace scree {

/// Writes a file of tables as they lie in memory, whole or not at all; numbers are little-endian.
class TableFileWriter {
public:
    /// what: the tables, for messages.
    TableFileWriter(std::filesystem::path file, std::string what) : file_(std::move(file)), what_(std::move(what)) {}

    void add(const void* bytes, uint64_t size) { parts_.push_back({bytes, size}); }
    template <class T>
    void add(const T& head)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        add(&head, sizeof head);
    }
    /// Writes all that was added, which must still be there. Throws InputError.
    void write() const;

private:
    struct Part {
        const void* bytes;
        uint64_t size;
    };
    std::filesystem::path file_;
    std::string what_;
    std::vector<Part> parts_;
};

/// Reads such a file from its beginning; every read throws InputError where the file is damaged or ends early.
class TableFileReader {
public:
    /// what: the tables, for messages. Throws InputError where there is no file.
    TableFileReader(const std::filesystem::path& file, std::string what);

    void read(void* bytes, uint64_t size);
    template <class T>
    T read()
    {
        static_assert(std::is_trivially_copyable_v<T>);
        T head;
        read(&head, sizeof head);
        return head;
    }
    uint64_t left() const { return left_; } ///< bytes not read yet
    /// That the file was not as it should be; found: in what way.
    InputError refuse(const std::string& found) const;
    /// Throws unless everything was read, and had this checksum.
    void finish(uint64_t checksum, uint64_t expected) const;

private:
    std::filesystem::path file_;
    std::string what_;
    std::ifstream stream_;
    uint64_t left_ = 0;
};

/// Calls `each` with a pointer to the bytes of every vector, and their number, in order.
template <class Each, class... Vectors>
void for_each_block(const Each& each, Vectors&... vectors)
{
    (each(vectors.data(), vectors.size() * sizeof(vectors[0])), ...);
}

} // namespace scree
