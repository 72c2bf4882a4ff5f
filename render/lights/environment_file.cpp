#include "render/lights/environment_file.h"

#include "base/drawing/picture_file.h"
#include "base/error.h"

#include <fmt/format.h>

#include <cmath>

namespace scree {

EnvironmentMap read_environment(const std::filesystem::path& file, const V3d& up, const Color& scale)
{
    const PictureFile picture = read_picture_file(file);
    const size_t width = picture.width, height = picture.height, channels = picture.channels;
    if (!picture.whole) {
        throw InputError(
            file.string(),
            fmt::format("a crop of {}x{} out of {}x{} pixels", width, height, picture.full_width, picture.full_height),
            "the whole picture");
    }

    const auto decode = [&](float x) { // IEC 61966-2-1
        if (!picture.eight_bit) return x;
        return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
    };
    std::vector<Color> texels(width * height);
    for (size_t i = 0; i < texels.size(); ++i) {
        const float* v = &picture.values[i * channels];
        texels[i] = channels >= 3 ? Color(decode(v[0]), decode(v[1]), decode(v[2])) : Color(decode(v[0]));
        for (const Real x : {texels[i].x, texels[i].y, texels[i].z}) {
            if (!std::isfinite(x) || x < 0) {
                throw InputError(fmt::format("{}: row {}, column {}", file.string(), i / width, i % width),
                                 fmt::format("{}", x), "a radiance of 0 or more");
            }
        }
    }
    return EnvironmentMap(std::move(texels), width, height, up, scale);
}

} // namespace scree
