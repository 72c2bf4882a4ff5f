#pragma once

#include "render/media/clearance_field.h"
#include "render/media/medium.h"
#include "render/media/medium_pyramid.h"

namespace scree {

/// How much work shells would save in a grid medium, from walks that simulate every scattering and note where a shell
/// would have replaced some.
struct ShellForecast {
    uint64_t scatterings = 0; ///< of all walks
    uint64_t queries = 0; ///< places at which a shell was asked for
    uint64_t shells = 0; ///< shells that fitted
    uint64_t skipped = 0; ///< scatterings inside these shells
    uint64_t lit = 0; ///< shells in which light would have been sampled

    /// Share of the scatterings that shells replace.
    double part() const
    {
        return scatterings > 0 ? static_cast<double>(skipped) / static_cast<double>(scatterings) : 0;
    }
    /// Mean number of scatterings that a shell replaces.
    double each() const { return shells > 0 ? static_cast<double>(skipped) / static_cast<double>(shells) : 0; }
    /// Work with shells over work without; lights: whether light is sampled at scatterings.
    double work(bool lights) const;
};

/// Walks from the faces of a box inwards, like diffuse light; the same for any number of threads. count: number of
/// shells available. Throws Cancelled.
ShellForecast forecast_shells(const Medium& medium, const MediumPyramid& pyramid, const Imath::Box3d& box,
                              const ClearanceField& clearance, size_t count, const Progress& progress);

} // namespace scree
