#pragma once

#include "render/stress/stress_scene.h"

#include <functional>

namespace scree {

/// A camera at `origin` that sees a w x h picture, and no light.
StressScene empty_scene(int width, int height, const V3d& origin, const V3d& target, double fov);
/// The same looking straight down -z from `height` at a square of a width.
StressScene scene_from_above(int pixels, double width, double height);

/// Means over the pixels of what a scene's camera sees, of parts^2 rays each; radiance: along a ray, in the scene's
/// unit.
std::vector<double> pixel_means(const StressScene& scene, int parts,
                                const std::function<double(const V3d& o, const V3d& d)>& radiance);

void add_constant(StressScene& scene, const Color& radiance);
/// A bright sky, a wide sun and a rectangle of light: what shows a turn, and makes no single bright samples.
void add_day(StressScene& scene);
void add_type(StressScene& scene, const std::string& name, const Material& material, const std::string& mesh = "");
void add_medium(StressScene& scene, const std::string& mesh, double sigma_t, const Weight& albedo, double g);

/// 48 grains that overlap by some per cent: glass, matte, cubes and rough gems, over a floor.
StressScene mixed_scene(const Progress& progress);
/// A cube of 2,400 grains of one material, or two of which every other grain is.
StressScene bed_scene(const std::vector<Material>& materials, const Progress& progress);
/// A cube from -1 to 1 filled with grains of a mean radius.
StressScene filled_scene(const Material& material, double radius, const Progress& progress);

/// A ball of radius 1 of a medium under a day; its coordinates are multiples of 2^-20.
StressScene ball_of_medium(double sigma_t, const Weight& albedo, double g);

TriangleMesh cube_mesh(double half);
/// 20 * 4^level triangles on a sphere.
TriangleMesh ball_mesh(double radius, int level);

} // namespace scree
