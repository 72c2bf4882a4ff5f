#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace scree::mesh_formats {

/// Reads numbers of a known width and byte order one after another, never past the end.
class ByteReader {
public:
    ByteReader(std::string_view bytes, std::endian order) : rest_(bytes), swap_(order != std::endian::native) {}

    size_t left() const { return rest_.size(); }

    /// Reads the next number; returns false if too few bytes are left.
    template <typename T>
    bool read(T& value)
    {
        if (rest_.size() < sizeof(T)) return false;
        char raw[sizeof(T)];
        for (size_t i = 0; i < sizeof(T); ++i) raw[swap_ ? sizeof(T) - 1 - i : i] = rest_[i];
        std::memcpy(&value, raw, sizeof(T));
        rest_.remove_prefix(sizeof(T));
        return true;
    }

    bool skip(size_t bytes)
    {
        if (rest_.size() < bytes) return false;
        rest_.remove_prefix(bytes);
        return true;
    }

private:
    std::string_view rest_;
    bool swap_;
};

} // namespace scree::mesh_formats
