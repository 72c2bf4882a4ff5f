#pragma once

#include "ingest/particles/particle_frame.h"

#include <cstdint>
#include <string>
#include <vector>

namespace scree::test {

/// Spheres in an upright periodic box from the origin; ids count from 1.
ParticleFrame periodic_frame(std::vector<Imath::V3d> positions, std::vector<float> radii, const Imath::V3d& box);

/// Touching spheres of diameter 1 on a lattice ("sc", "bcc", "fcc" or "hcp"), `cells` of its cells along each axis.
ParticleFrame lattice(const std::string& kind, int cells, float radius = 0.5f);

/// Hard spheres in equilibrium by Metropolis moves: 4 cells^3 of them, diameters drawn from `diameters`, started from
/// an fcc lattice.
ParticleFrame hard_sphere_fluid(int cells, double fraction, int sweeps, uint64_t seed,
                                const std::vector<double>& diameters = {1});

/// The frame with all lengths multiplied.
ParticleFrame scaled(ParticleFrame frame, double factor);

/// The frame without its box.
ParticleFrame without_box(ParticleFrame frame);

} // namespace scree::test
