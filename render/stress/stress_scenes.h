#pragma once

#include "render/stress/stress_scene.h"

#include <functional>

namespace scree {

/// A scene without lights, with a camera at `origin` and a picture of width x height pixels.
StressScene empty_scene(int width, int height, const V3d& origin, const V3d& target, double fov);
/// The same with an orthographic camera that looks down -z from `height` at a square `width` wide.
StressScene scene_from_above(int pixels, double width, double height);

/// The mean of `radiance` over parts^2 camera rays through each pixel. radiance: of a ray from o along d, in the
/// scene's unit.
std::vector<double> pixel_means(const StressScene& scene, int parts,
                                const std::function<double(const V3d& o, const V3d& d)>& radiance);

void add_constant(StressScene& scene, const Color& radiance);
/// Adds a bright sky, a wide sun and a rectangle light: together they show a turn, and make no rare bright samples.
void add_day(StressScene& scene);
void add_type(StressScene& scene, const std::string& name, const Material& material, const std::string& mesh = "");
void add_medium(StressScene& scene, const std::string& mesh, double sigma_t, const Weight& albedo, double g);

/// 48 grains that overlap by some per cent: glass, matte, cubes and rough gems, over a floor.
StressScene mixed_scene(const Progress& progress);
/// A cube of 2,400 grains that have these materials in turn.
StressScene bed_scene(const std::vector<Material>& materials, const Progress& progress);
/// A cube from -1 to 1 filled with grains of a mean radius.
StressScene filled_scene(const Material& material, double radius, const Progress& progress);

/// A ball of medium of radius 1 under add_day; its coordinates are multiples of 2^-20.
StressScene ball_of_medium(double sigma_t, const Weight& albedo, double g);

TriangleMesh cube_mesh(double half);
/// 20 * 4^level triangles on a sphere.
TriangleMesh ball_mesh(double radius, int level);

} // namespace scree
