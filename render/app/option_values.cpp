#include "render/app/option_values.h"

#include "base/error.h"
#include "base/text.h"

namespace scree {

std::pair<int, int> parse_picture_size(const std::string& text)
{
    constexpr int64_t most = 65536;
    const size_t x = text.find('x');
    const auto width = to_int64(text.substr(0, x));
    const auto height = x == std::string::npos ? std::nullopt : to_int64(text.substr(x + 1));
    if (!width || !height || *width < 1 || *height < 1 || *width > most || *height > most) {
        throw InputError("--size", "'" + text + "'", "WIDTHxHEIGHT, e.g. 640x480, whole numbers in 1..65536");
    }
    return {static_cast<int>(*width), static_cast<int>(*height)};
}

std::pair<std::string, std::string> parse_override(const std::string& text)
{
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw InputError("-D", "'" + text + "'", "key=value, e.g. camera.fov=40");
    return {text.substr(0, equals), text.substr(equals + 1)};
}

} // namespace scree
