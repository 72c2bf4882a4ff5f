#include "base/drawing/bitmap_font.h"

namespace scree {

namespace {

/// '!' to '~', drawn for Scree: bits 5 r to 5 r + 4 are row r, the highest bit of a row on the left.
constexpr std::array<uint64_t, 94> glyphs{
    0x000100421084ull, 0x00000000294aull, 0x000295f57d4aull, 0x00013c5751e4ull, 0x0000e6820b38ull, 0x00036554524cull,
    0x000000002084ull, 0x000088842082ull, 0x000208210888ull, 0x000009575480ull, 0x0000084f9080ull, 0x004118000000ull,
    0x0000000f8000ull, 0x000318000000ull, 0x000020820820ull, 0x0003a39ace2eull, 0x000388421184ull, 0x0007d041062eull,
    0x0003a211105full, 0x000085f928c2ull, 0x0003a210fa1full, 0x0003a31f4106ull, 0x00021082083full, 0x0003a317462eull,
    0x00030417c62eull, 0x000018c03180ull, 0x000208c03180ull, 0x000088882082ull, 0x000001f07c00ull, 0x000208208888ull,
    0x00010041062eull, 0x0003ab56862eull, 0x0004631fc62eull, 0x0007a31f463eull, 0x0003a308422eull, 0x0007a318c63eull,
    0x0007e10f421full, 0x0004210f421full, 0x0003e31bc22eull, 0x0004631fc631ull, 0x00038842108eull, 0x000324210847ull,
    0x0004654c5251ull, 0x0007e1084210ull, 0x0004631ad771ull, 0x00046319d731ull, 0x0003a318c62eull, 0x0004210f463eull,
    0x00036558c62eull, 0x0004654f463eull, 0x00078217420full, 0x00010842109full, 0x0003a318c631ull, 0x00011518c631ull,
    0x0004775ac631ull, 0x000462a22a31ull, 0x000108422a31ull, 0x0007e082083full, 0x00039084210eull, 0x000002222200ull,
    0x00038421084eull, 0x000000004544ull, 0x0007c0000000ull, 0x000000000888ull, 0x0003e2f0b800ull, 0x0007a318fa10ull,
    0x0003a1083800ull, 0x0003e318bc21ull, 0x0003a1f8b800ull, 0x000210847906ull, 0x0e0be318bc00ull, 0x00046318fa10ull,
    0x000388423004ull, 0x006484230040ull, 0x0004a98a4a10ull, 0x00038842108cull, 0x00056b5ae800ull, 0x00046318f800ull,
    0x0003a318b800ull, 0x1087a318f800ull, 0x010be318bc00ull, 0x0004210cd800ull, 0x000782e83c00ull, 0x000190847908ull,
    0x0003e318c400ull, 0x00011518c400ull, 0x0002ab58c400ull, 0x000454454400ull, 0x0e0be318c400ull, 0x0007d0417c00ull,
    0x000088441082ull, 0x000108421084ull, 0x000208411088ull, 0x0000002aa000ull};

constexpr uint64_t box = 0x0007e318c63full;

} // namespace

Glyph glyph_of(char letter)
{
    Glyph glyph;
    if (letter == ' ') return glyph;
    const uint64_t bits = letter >= '!' && letter <= '~' ? glyphs[static_cast<size_t>(letter - '!')] : box;
    for (int r = 0; r < Glyph::height; ++r)
        glyph.rows[static_cast<size_t>(r)] = static_cast<uint8_t>(bits >> (5 * r) & 31);
    return glyph;
}

} // namespace scree
