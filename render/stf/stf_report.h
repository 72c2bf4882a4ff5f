#pragma once

#include "render/gsdf/gsdf_subject.h"
#include "render/stf/shell_maps.h"

#include <optional>
#include <string>
#include <vector>

namespace scree {

/// What a shell does to light that sets out from its centre; shares are of all light, at albedo 1 unless said
/// otherwise.
struct ShellNumbers {
    double radius = 0; ///< in mean free paths
    double unscattered = 0, single = 0, multiple = 0;
    double single_left = 0, multiple_left = 0, absorbed = 0; ///< at the albedo asked for; as much goes straight through
    double scatterings = 0; ///< mean number
    double cos_t = 0; ///< mean cosine of theta_t
    double straight = 0; ///< mean cosine between the ways in and out
    double mean_cosine = 0; ///< to the normal, after two scatterings and more
    CosineDistance distance; ///< of the same
    uint64_t records = 0;
};
ShellNumbers shell_numbers(const StfShell& shell, double albedo);

/// The shells of a phase function, found, and what to say of them.
struct StfReport {
    std::string name; ///< of the grain, or g=...
    std::optional<GsdfSubject> grain; ///< whose phase function it is
    double gsdf_error = 0; ///< of the grain's GSDF, relative, of the density of directions
    std::shared_ptr<const Stf> stf;
    double albedo = 1;
    uint64_t walks = 0; ///< a shell, that scatter
    std::vector<ShellNumbers> shells;
    std::vector<double> seconds; ///< that each shell took, 0 from the cache
    std::string remark;

    struct Figure {
        std::string file;
        std::vector<ShellMaps> maps; ///< by growing radius
    };
    std::optional<Figure> figure;
};

/// The line of names over the lines of shells, and such a line.
std::string stf_table_head(double albedo);
std::string stf_table_line(const StfReport& report, size_t shell);

/// Everything in numbers, with the maps of the figure: an array, an object a phase function.
std::string stf_json(const std::vector<StfReport>& reports);

} // namespace scree
