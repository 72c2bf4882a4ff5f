#pragma once

#include "render/media/clearance_field.h"
#include "render/media/medium.h"
#include "render/media/medium_pyramid.h"

namespace scree {

/// What shells would do for light in a medium of grids, by walks from scattering to scattering that note where a shell
/// would have stood for a part of them.
struct ShellForecast {
    uint64_t scatterings = 0; ///< of all walks
    uint64_t queries = 0; ///< places at which a shell was asked for
    uint64_t shells = 0; ///< that fitted
    uint64_t skipped = 0; ///< scatterings within them
    uint64_t lit = 0; ///< shells that light would have been looked for in

    /// Part of the scatterings that shells stand for.
    double part() const
    {
        return scatterings > 0 ? static_cast<double>(skipped) / static_cast<double>(scatterings) : 0;
    }
    /// Scatterings that a shell stands for.
    double each() const { return shells > 0 ? static_cast<double>(skipped) / static_cast<double>(shells) : 0; }
    /// Work with shells, as a part of that without; lights: whether scatterings look for light.
    double work(bool lights) const;
};

/// Walks from the faces of a box inwards, as of diffuse light; the same on any number of threads. count: of shells
/// there are. Throws Cancelled.
ShellForecast forecast_shells(const Medium& medium, const MediumPyramid& pyramid, const Imath::Box3d& box,
                              const ClearanceField& clearance, size_t count, const Progress& progress);

} // namespace scree
