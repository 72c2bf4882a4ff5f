#pragma once

#include "base/progress.h"
#include "base/render_space.h"
#include "render/media/grid_medium.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>

#include <filesystem>
#include <string>

namespace scree {

/// Which grids of an OpenVDB file make a medium.
struct VdbMediumOptions {
    std::string density = "density"; ///< name of its grid of floats, doubles or vectors of three
    std::string albedo; ///< the same types, in 0..1; empty: GridMediumOptions::albedo everywhere
    std::string g; ///< floats or doubles, |g| < 1; empty: GridMediumOptions::g everywhere
    GridMediumOptions medium;
    /// Places in the scene = places in the file * to_scene, as row vectors. Sigma_t is per unit of the scene.
    Imath::M44d to_scene;
};

/// Reads a medium from an OpenVDB file: clouds, smoke, what a simulation wrote.
///
/// Throws InputError naming the file and, where a name is not found, its grids; also for other types of grids, level
/// sets, transforms that are not linear, densities that are negative or not finite, albedos outside of 0..1 and |g|
/// >= 1. Cancelled.
GridMedium read_vdb_medium(const std::filesystem::path& file, const VdbMediumOptions& options, const RenderSpace& space,
                           const Progress& progress);

/// A box in the scene around everything that may not be empty: what a scene is laid out by before its media are made.
///
/// From the file's metadata where it has them, else the grid is read. Throws InputError as read_vdb_medium().
Imath::Box3d vdb_medium_bounds(const std::filesystem::path& file, const VdbMediumOptions& options);

} // namespace scree
