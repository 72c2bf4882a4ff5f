#pragma once

#include "base/drawing/picture.h"

#include <string>

namespace scree {

// What the figures of `scree grains` have in common.

inline constexpr ScreenColor figure_paper{255, 255, 255}, figure_ink{40, 40, 40}, figure_faint{140, 140, 140};

/// Colours of a figure, from black through purple and orange to pale yellow; at: 0 to 1, beyond it as at the ends.
ScreenColor heat_color(double at);

/// Text whose upper edge is at y and whose middle at x.
void draw_text_centred(Picture& picture, int x, int y, const std::string& text, ScreenColor color, int scale);

struct FigureSize {
    int width = 0, height = 0; ///< pixels
};

/// Smaller figures have no room for their text.
inline constexpr FigureSize least_figure_size{480, 320};

/// WIDTHxHEIGHT as --size has it. Throws InputError.
FigureSize read_figure_size(const std::string& text);

} // namespace scree
