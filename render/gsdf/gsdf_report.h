#pragma once

#include "render/gsdf/gsdf_cache.h"
#include "render/gsdf/gsdf_subject.h"
#include "render/gsdf/map_errors.h"

#include <optional>
#include <string>
#include <vector>

namespace scree {

/// The scattering of one grain, and what to report about it.
struct GsdfReport {
    GsdfSubject subject;
    FoundGsdf found;
    double seconds = 0; ///< to find or trace it in this run
    double wanted = 0; ///< error asked for
    /// The figure's file and numbers.
    struct Figure {
        std::string file;
        uint64_t paths = 0;
        MapErrors errors;
    };
    std::optional<Figure> figure;
};

/// The table's line of column names, and the line of one grain.
std::string gsdf_table_head();
std::string gsdf_table_line(const GsdfReport& report);

/// The errors of the forms of scattering, as lines of a table.
std::vector<std::string> form_table(const MapErrors& errors, const std::string& grain);

/// All numbers as JSON, with alpha0 over q and the phase function over the polar angle: an array of one object per
/// grain.
std::string gsdf_json(const std::vector<GsdfReport>& reports);

/// The phase function of scattered light from far away: density per solid angle, in DirectionGrid::rows bins of equal
/// width of the polar angle from straight on; its mean over the sphere is 1 / (4 pi).
std::vector<double> phase_function(const Gsdf& gsdf);

} // namespace scree
