#pragma once

#include "base/error.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

namespace scree {

/// Writes tables to a file exactly as stored in memory (little-endian); the file appears whole or not at all.
class TableFileWriter {
public:
    /// what: name of the tables, for messages.
    TableFileWriter(std::filesystem::path file, std::string what) : file_(std::move(file)), what_(std::move(what)) {}

    void add(const void* bytes, uint64_t size) { parts_.push_back({bytes, size}); }
    template <class T>
    void add(const T& head)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        add(&head, sizeof head);
    }
    /// Writes everything that was added; that memory must still be valid. Throws InputError.
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

/// Reads a file of TableFileWriter from its beginning; every read throws InputError if the file is damaged or too
/// short.
class TableFileReader {
public:
    /// what: name of the tables, for messages. Throws InputError when the file cannot be opened.
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
    /// The error for a file that cannot be used; found: what is wrong with it.
    InputError refuse(const std::string& found) const;
    /// Throws InputError unless every byte was read and `checksum` equals `expected`.
    void finish(uint64_t checksum, uint64_t expected) const;

private:
    std::filesystem::path file_;
    std::string what_;
    std::ifstream stream_;
    uint64_t left_ = 0;
};

/// Calls `each(pointer to the bytes, number of bytes)` for every vector, in order.
template <class Each, class... Vectors>
void for_each_block(const Each& each, Vectors&... vectors)
{
    (each(vectors.data(), vectors.size() * sizeof(vectors[0])), ...);
}

} // namespace scree
