#include "render/film/exr_output.h"

#include "ingest/support/atomic_file.h"
#include "ingest/support/error.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <fstream>

namespace scree {

namespace {

/// IEC 61966-2-1.
float to_srgb(float x)
{
    x = std::clamp(x, 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

} // namespace

void check_preview_format(const std::filesystem::path& path)
{
    const auto out = OIIO::ImageOutput::create(path.string());
    if (out && out->supports("ioproxy")) return;
    throw InputError(path.string(), "the extension '" + path.extension().string() + "'", "a picture format: .exr, .png, .jpg, ...");
}

void write_preview(const std::filesystem::path& path, const Film& film)
{
    check_preview_format(path);
    const auto out = OIIO::ImageOutput::create(path.string());
    std::vector<float> values;
    values.reserve(3 * film.pixels().size());
    for (const Pixel& pixel : film.pixels()) {
        const C3f c = pixel.mean();
        for (const float x : {c.x, c.y, c.z}) values.push_back(to_srgb(x));
    }
    const OIIO::ImageSpec spec(film.x1() - film.x0(), film.y1() - film.y0(), 3, OIIO::TypeUInt8);
    // Through memory: on a full disk the PNG writer reports nothing, and the JPEG library ends the program.
    OIIO::Filesystem::IOVecOutput memory;
    if (!out->set_ioproxy(&memory) || !out->open(path.string(), spec) || !out->write_image(OIIO::TypeFloat, values.data()) || !out->close()) {
        throw InputError(path.string(), out->geterror(), "a picture that the format can hold");
    }
    AtomicFile file(path);
    std::ofstream bytes(file.temporary(), std::ios::binary);
    bytes.write(reinterpret_cast<const char*>(memory.buffer().data()), static_cast<std::streamsize>(memory.buffer().size()));
    bytes.close();
    if (!bytes) throw InputError(path.string(), "a disk that is full or cannot be written", "room for the picture");
    file.commit();
}

} // namespace scree
