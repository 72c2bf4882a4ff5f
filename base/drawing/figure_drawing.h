#pragma once

#include "base/drawing/picture.h"

#include <string>

namespace scree {

// Tools shared by the figures of `scree grains`.

inline constexpr ScreenColor figure_paper{255, 255, 255}, figure_ink{40, 40, 40}, figure_faint{140, 140, 140};

/// A colour scale for figures, from black through purple and orange to pale yellow; at: clamped to 0..1.
ScreenColor heat_color(double at);

/// Draws text with its upper edge at y, centred on x.
void draw_text_centred(Picture& picture, int x, int y, const std::string& text, ScreenColor color, int scale);

struct FigureSize {
    int width = 0, height = 0; ///< pixels
};

/// Smaller figures have no room for their text.
inline constexpr FigureSize least_figure_size{480, 320};

/// Reads the WIDTHxHEIGHT of --size. Throws InputError.
FigureSize read_figure_size(const std::string& text);

} // namespace scree
