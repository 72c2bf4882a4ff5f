#pragma once

#include "render/gsdf/gsdf_subject.h"
#include "render/stf/shell_maps.h"

#include <optional>
#include <string>
#include <vector>

namespace scree {

/// How a shell scatters light that starts at its centre; shares are of all light, at albedo 1 unless said otherwise.
struct ShellNumbers {
    double radius = 0; ///< the paper's r, in mean free paths
    double unscattered = 0, single = 0, multiple = 0; ///< alpha_s^0, alpha_s^1 and alpha_s^m in the paper, at albedo 1
    double single_left = 0, multiple_left = 0, absorbed = 0; ///< at the albedo asked for; `unscattered` is the same
    double scatterings = 0; ///< mean number
    double cos_t = 0; ///< mean cosine of theta_t
    double straight = 0; ///< mean cosine between the first and the last direction
    double mean_cosine = 0; ///< to the normal, after at least two scatterings
    CosineDistance distance; ///< after at least two scatterings
    uint64_t records = 0;
};
ShellNumbers shell_numbers(const StfShell& shell, double albedo);

/// The shells of one phase function, and what to report about them.
struct StfReport {
    std::string name; ///< of the grain, or g=...
    std::optional<GsdfSubject> grain; ///< whose phase function it is
    double gsdf_error = 0; ///< relative error of the directional density of the grain's GSDF
    std::shared_ptr<const Stf> stf;
    double albedo = 1;
    uint64_t walks = 0; ///< per shell, that scatter
    std::vector<ShellNumbers> shells;
    std::vector<double> seconds; ///< that each shell took; 0 for a shell from the cache
    std::string remark;

    struct Figure {
        std::string file;
        std::vector<ShellMaps> maps; ///< by growing radius
    };
    std::optional<Figure> figure;
};

/// The table's line of column names, and the line of one shell.
std::string stf_table_head(double albedo);
std::string stf_table_line(const StfReport& report, size_t shell);

/// All numbers as JSON, with the maps of the figure: an array of one object per phase function.
std::string stf_json(const std::vector<StfReport>& reports);

} // namespace scree
