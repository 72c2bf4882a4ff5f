#include "render/film/exr_output.h"

#include "base/drawing/picture_file.h"
#include "base/drawing/srgb.h"
#include "base/error.h"

namespace scree {

void check_preview_format(const std::filesystem::path& path)
{
    if (can_write_picture_file(path)) return;
    throw InputError(path.string(), "the extension '" + path.extension().string() + "'",
                     "a picture format: .exr, .png, .jpg, ...");
}

void write_preview(const std::filesystem::path& path, const Film& film)
{
    check_preview_format(path);
    std::vector<float> values;
    values.reserve(3 * film.pixels().size());
    for (const Pixel& pixel : film.pixels()) {
        const Color c = pixel.mean();
        for (const Real x : {c.x, c.y, c.z}) values.push_back(to_srgb(static_cast<float>(x)));
    }
    write_picture_file(path, film.x1() - film.x0(), film.y1() - film.y0(), values);
}

} // namespace scree
