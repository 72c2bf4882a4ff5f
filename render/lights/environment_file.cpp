#include "render/lights/environment_file.h"

#include "ingest/support/error.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>

namespace scree {

EnvironmentMap read_environment(const std::filesystem::path& file, const V3d& up, const C3f& scale)
{
    OIIO::ImageBuf image(file.string());
    if (!image.read(0, 0, true, OIIO::TypeFloat)) {
        throw InputError(file.string(), image.geterror(), "a picture OpenImageIO can read (EXR, HDR, PNG, ...)");
    }
    const OIIO::ImageSpec& spec = image.spec();
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width || spec.height != spec.full_height) {
        throw InputError(file.string(), fmt::format("a crop of {}x{} out of {}x{} pixels", spec.width, spec.height, spec.full_width, spec.full_height),
                         "the whole picture");
    }
    const bool bytes = image.nativespec().format == OIIO::TypeUInt8;
    const int channels = spec.nchannels;
    const auto width = static_cast<size_t>(spec.width), height = static_cast<size_t>(spec.height);
    std::vector<float> values(width * height * static_cast<size_t>(channels));
    image.get_pixels(image.roi(), OIIO::TypeFloat, values.data());

    const auto decode = [bytes](float x) { // IEC 61966-2-1
        if (!bytes) return x;
        return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
    };
    std::vector<C3f> texels(width * height);
    for (size_t i = 0; i < texels.size(); ++i) {
        const float* v = &values[i * static_cast<size_t>(channels)];
        texels[i] = channels >= 3 ? C3f(decode(v[0]), decode(v[1]), decode(v[2])) : C3f(decode(v[0]));
        for (const float x : {texels[i].x, texels[i].y, texels[i].z}) {
            if (!std::isfinite(x) || x < 0) {
                throw InputError(fmt::format("{}: row {}, column {}", file.string(), i / width, i % width), fmt::format("{}", x),
                                 "a radiance of 0 or more");
            }
        }
    }
    return EnvironmentMap(std::move(texels), width, height, up, scale);
}

} // namespace scree
