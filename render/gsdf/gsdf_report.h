#pragma once

#include "render/gsdf/gsdf_cache.h"
#include "render/gsdf/gsdf_subject.h"
#include "render/gsdf/map_errors.h"

#include <optional>
#include <string>
#include <vector>

namespace scree {

/// A grain's scattering, found, and what to say of it.
struct GsdfReport {
    GsdfSubject subject;
    FoundGsdf found;
    double seconds = 0; ///< of finding it, this time
    double wanted = 0; ///< error
    /// Of the figure, if one was drawn.
    struct Figure {
        std::string file;
        uint64_t paths = 0;
        MapErrors errors;
    };
    std::optional<Figure> figure;
};

/// The line of names over the lines of grains, and such a line.
std::string gsdf_table_head();
std::string gsdf_table_line(const GsdfReport& report);

/// What the forms of scattering miss, as lines of a table.
std::vector<std::string> form_table(const MapErrors& errors, const std::string& grain);

/// Everything in numbers, with alpha0 over q and the phase function over the polar angle: an array, an object a grain.
std::string gsdf_json(const std::vector<GsdfReport>& reports);

/// Scattering of light from afar per solid angle by the polar angle from straight on, in DirectionGrid::rows bins of
/// equal width, given that it is scattered: a mean of 1 / (4 pi).
std::vector<double> phase_function(const Gsdf& gsdf);

} // namespace scree
