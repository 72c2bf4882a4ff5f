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
    std::string density = "density"; ///< name of the density grid: floats, doubles or vectors of three
    /// name of the albedo grid: the same types, in 0..1; empty: GridMediumOptions::albedo everywhere
    std::string albedo;
    std::string g; ///< name of the grid of g: floats or doubles, |g| < 1; empty: GridMediumOptions::g everywhere
    GridMediumOptions medium;
    /// Point in the scene = point in the file * to_scene, as row vectors. sigma_t is per unit of the scene.
    Imath::M44d to_scene;
};

/// Reads a medium from an OpenVDB file: clouds, smoke or other output of a simulation.
///
/// Throws InputError that names the file; if a grid is missing, the error lists the grids of the file. Also for other
/// types of grids, level sets, transforms that are not linear, densities that are negative or not finite, albedos
/// outside 0..1 and |g| >= 1. Throws Cancelled.
GridMedium read_vdb_medium(const std::filesystem::path& file, const VdbMediumOptions& options, const RenderSpace& space,
                           const Progress& progress);

/// A box in scene coordinates around everything that may be non-empty; used to lay out a scene before its media are
/// made.
///
/// Taken from the file's metadata if present, else the grid is read. Throws InputError like read_vdb_medium().
Imath::Box3d vdb_medium_bounds(const std::filesystem::path& file, const VdbMediumOptions& options);

} // namespace scree
