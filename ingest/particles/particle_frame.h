#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathQuat.h>
#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// The simulation cell of a frame: a parallelepiped `lo + u a + v b + w c`, u, v, w in 0..1, in the file's unit.
struct SimulationBox {
    Imath::V3d lo{0};
    std::array<Imath::V3d, 3> edges{Imath::V3d{0}, Imath::V3d{0}, Imath::V3d{0}}; ///< a, b, c
    std::array<bool, 3> periodic{false, false, false};
    bool triclinic = false;

    double volume() const { return std::abs(edges[0].dot(edges[1].cross(edges[2]))); }
};

/// One frame of a granular simulation: a structure of arrays, one entry per sphere, in the file's unit of length.
///
/// Sorted by id when the file has ids; without ids, id is the row (0, 1, ...). A sphere's identity (and so its grain
/// type and rotation) follows its id. All arrays have `size()` entries, except `orientation`, which may be empty.
struct ParticleFrame {
    std::vector<Imath::V3d> position; ///< centres, in the file's coordinates, as double
    std::vector<float> radius; ///< >= 0 and finite
    std::vector<int32_t> type; ///< the file's own type number; 1 where the file has none
    std::vector<uint64_t> id;
    std::vector<Imath::Quatf> orientation; ///< unit quaternions (w, x, y, z), or empty
    bool has_ids = false; ///< whether the ids come from the file

    std::optional<SimulationBox> box;
    std::optional<Imath::Box3d> domain; ///< bounds of the filled mesh, if the spheres list a fill
    int64_t step = 0;
    std::optional<double> time;
    std::string units; ///< LAMMPS unit style ("lj", "si", ...), empty when unknown

    /// A point near the middle of the spheres; positions relative to it keep their precision as float.
    Imath::V3d origin{0};

    size_t size() const { return position.size(); }

    /// The centre of sphere i relative to `origin`.
    Imath::V3f relative_position(size_t i) const { return Imath::V3f(position[i] - origin); }
};

/// The middle of the bounding box of the positions, which readers use as a frame's origin; 0 without positions.
Imath::V3d middle_of_bounds(const std::vector<Imath::V3d>& positions);

} // namespace scree
