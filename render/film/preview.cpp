#include "render/film/exr_output.h"

#include "ingest/support/atomic_file.h"
#include "ingest/support/error.h"

#include <OpenImageIO/imageio.h>

namespace scree {

namespace {

/// IEC 61966-2-1.
float to_srgb(float x)
{
    x = std::clamp(x, 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

} // namespace

void write_preview(const std::filesystem::path& path, const Film& film)
{
    AtomicFile file(path);
    const auto out = OIIO::ImageOutput::create(file.temporary().string());
    if (!out) throw InputError(path.string(), "the extension '" + path.extension().string() + "'", "a picture format: .exr, .png, .jpg, ...");
    std::vector<float> values;
    values.reserve(3 * film.pixels().size());
    for (const Pixel& pixel : film.pixels()) {
        const C3f c = pixel.mean();
        for (const float x : {c.x, c.y, c.z}) values.push_back(to_srgb(x));
    }
    const OIIO::ImageSpec spec(film.x1() - film.x0(), film.y1() - film.y0(), 3, OIIO::TypeUInt8);
    if (!out->open(file.temporary().string(), spec) || !out->write_image(OIIO::TypeFloat, values.data()) || !out->close()) {
        throw InputError(path.string(), out->geterror(), "a file that can be written");
    }
    file.commit();
}

} // namespace scree
