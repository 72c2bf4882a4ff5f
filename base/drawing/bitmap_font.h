#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace scree {

/// A glyph 5 pixels wide: rows from the top, the lowest 5 bits of each from left to right; row 6 stands on the
/// baseline.
///
/// For pictures on machines without font files. Printable ASCII; a box for everything else.
struct Glyph {
    static constexpr int width = 5, height = 9;
    std::array<uint8_t, height> rows{};
};

Glyph glyph_of(char letter);

} // namespace scree
