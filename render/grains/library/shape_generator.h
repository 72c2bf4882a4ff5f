#pragma once

#include "base/math.h"
#include "render/grains/library/grain_library.h"

namespace scree {

/// The input of a generator; it has a value for every parameter in the generator's list.
struct ShapeRequest {
    uint64_t seed = 0;
    uint64_t triangles = 0;
    std::map<std::string, double> parameters;

    double operator[](const std::string& name) const { return parameters.at(name); }
};

/// Makes a shape of one family, of any size around the origin and oriented outwards.
using ShapeGenerator = TriangleMesh (*)(const ShapeRequest& request);

/// A sucrose crystal, or several grown together: the faces of its habit, chipped corners, worn edges.
TriangleMesh make_crystal(const ShapeRequest& request);
/// Broken and worn stone: an ellipsoid cut by planes and shallow shells, with rough skin.
TriangleMesh make_pebble(const ShapeRequest& request);
/// A lump with granules half sunk into its skin.
TriangleMesh make_cluster(const ShapeRequest& request);
/// A stellar dendrite: a closed flat solid of six branched arms with ridges.
TriangleMesh make_snowflake(const ShapeRequest& request);
/// Wound fibres: closed tubes that run through each other.
TriangleMesh make_fibre_ball(const ShapeRequest& request);
/// A curled piece of bark.
TriangleMesh make_bark_curl(const ShapeRequest& request);

} // namespace scree
