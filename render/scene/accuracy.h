#pragma once

#include "base/enum_names.h"
#include "render/film/pixel_size.h"

#include <array>
#include <cstdint>

namespace scree {

/// How far approximations may go.
enum class Accuracy : uint8_t { reference, high, standard, draft };

/// All numbers that an accuracy sets. docs/bench has the measured errors.
struct AccuracyLevel {
    Accuracy accuracy;
    const char* name;
    uint32_t explicit_grains; ///< auto: grains of a path traced as explicit geometry; further ones are proxies
    double least_pixels; ///< auto: if a path's first grain looks narrower in the picture, all are proxies
    double depth_radii; ///< auto: a medium replaces the grains from this depth below every face, in mean radii,
    double depth_flights; ///< but from no fewer mean free paths of that medium
    double gsdf_error; ///< mean relative error of the directional densities of a GSDF
    uint64_t stf_walks; ///< walks behind each table of an STF
};

inline constexpr std::array<AccuracyLevel, 4> accuracy_levels{{
    // accuracy, name, explicit_grains, least_pixels, depth_radii, depth_flights, gsdf_error, stf_walks
    {Accuracy::reference, "reference", all_grains, 0, 0, 0, 0.005, uint64_t{1} << 19},
    {Accuracy::high, "high", 1, 0.5, 8, 5, 0.01, uint64_t{1} << 18},
    {Accuracy::standard, "standard", 1, 1, 4, 2.5, 0.03, uint64_t{1} << 17},
    {Accuracy::draft, "draft", 0, 0, 2, 1, 0.08, uint64_t{1} << 15},
}};

/// The row of an accuracy.
constexpr const AccuracyLevel& level_of(Accuracy accuracy)
{
    for (const AccuracyLevel& level : accuracy_levels) {
        if (level.accuracy == accuracy) return level;
    }
    return accuracy_levels[0];
}

inline const EnumNames<Accuracy> accuracy_names = [] {
    std::vector<EnumNames<Accuracy>::Row> rows;
    for (const AccuracyLevel& level : accuracy_levels) rows.emplace_back(level.accuracy, level.name);
    return EnumNames<Accuracy>(std::move(rows));
}();

} // namespace scree
