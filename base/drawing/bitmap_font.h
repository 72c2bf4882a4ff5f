#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace scree {

/// A glyph 5 pixels wide: rows from the top, row 6 on the baseline; the lowest 5 bits of a row are its pixels from left
/// to right.
///
/// For pictures on machines without font files.
struct Glyph {
    static constexpr int width = 5, height = 9;
    std::array<uint8_t, height> rows{};
};

/// The glyph of a printable ASCII character; a box for every other character.
Glyph glyph_of(char letter);

} // namespace scree
