#include "render/app/radius_option.h"

#include "base/error.h"
#include "base/text.h"

#include <cmath>
#include <filesystem>
#include <limits>

namespace scree {

namespace {

std::vector<std::string> split_commas(const std::string& text)
{
    std::vector<std::string> parts;
    size_t start = 0;
    for (;;) {
        const size_t comma = text.find(',', start);
        parts.push_back(text.substr(start, comma - start));
        if (comma == std::string::npos) return parts;
        start = comma + 1;
    }
}

} // namespace

ParticleReadOptions parse_radius_options(const std::vector<std::string>& values)
{
    ParticleReadOptions options;
    for (const std::string& value : values) {
        for (const std::string& part : split_commas(value)) {
            const size_t equals = part.find('=');
            const std::optional<double> radius =
                to_double(equals == std::string::npos ? part : part.substr(equals + 1));
            const std::optional<int64_t> type = equals == std::string::npos ? 0 : to_int64(part.substr(0, equals));
            const bool type_fits =
                type && *type >= std::numeric_limits<int32_t>::min() && *type <= std::numeric_limits<int32_t>::max();
            if (!radius || !type_fits || !(*radius >= 0) || !std::isfinite(*radius))
                throw InputError("--radius", in_quotes(part), "a radius of 0 or more, or TYPE=RADIUS",
                                 "as in --radius 0.5, or --radius 1=0.5 2=0.7");
            if (equals == std::string::npos)
                options.radius = *radius;
            else
                options.radius_of_type[static_cast<int32_t>(*type)] = *radius;
        }
    }
    return options;
}

void take_radii_from_files(std::vector<std::string>& files, std::vector<std::string>& radii)
{
    if (radii.empty()) return;
    std::vector<std::string> others;
    for (std::string& word : files) {
        const size_t equals = word.find('=');
        std::error_code ignored;
        const bool is_radius =
            equals != std::string::npos && to_int64(word.substr(0, equals)) && !std::filesystem::exists(word, ignored);
        (is_radius ? radii : others).push_back(std::move(word));
    }
    files = std::move(others);
}

} // namespace scree
