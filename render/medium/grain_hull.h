#pragma once

#include "render/medium/level_set_surface.h"

namespace scree {

/// The surface of the union of spheres that are `more` larger. Throws InputError, Cancelled.
RegionSurface dilated_spheres(std::span<const GrainStore::Sphere> spheres, double more, const VoxelLattice& lattice, const Progress& progress);

} // namespace scree
