#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

/// A colour as encoded for a screen, 0..255 per channel.
struct ScreenColor {
    uint8_t r = 0, g = 0, b = 0;
};

/// A picture to draw diagrams on; coordinates are pixels from the top left, and drawing outside of it is cut off.
class Picture {
public:
    Picture(int width, int height, ScreenColor background);

    int width() const { return width_; }
    int height() const { return height_; }
    ScreenColor pixel(int x, int y) const;

    void fill_rectangle(int x, int y, int width, int height, ScreenColor color);
    void draw_frame(int x, int y, int width, int height, ScreenColor color);
    /// A disc with smooth edges, and a darker rim if it is large enough; `clip`: x, y, width, height.
    void draw_disc(double x, double y, double radius, ScreenColor color, const int (&clip)[4]);
    /// Text with its upper left corner at (x, y); each pixel of the font is `scale` wide.
    void draw_text(int x, int y, const std::string& text, ScreenColor color, int scale = 2);
    static int text_width(const std::string& text, int scale = 2);
    static int text_height(int scale = 2);

    /// Writes the picture in the format of the extension (.png); the file appears whole or not at all. Throws
    /// InputError.
    void write(const std::filesystem::path& path) const;

private:
    void blend(int x, int y, ScreenColor color, double alpha);

    int width_, height_;
    std::vector<uint8_t> rgb_;
};

} // namespace scree
