#pragma once

#include "base/progress.h"
#include "packing/tiles/tile_spheres.h"

#include <array>
#include <cstdint>
#include <vector>

namespace scree {

/// Soft spheres in a periodic cuboid, moved until they do not overlap or until their forces balance.
///
/// The forces are harmonic repulsion by equal springs, which O'Hern, Silbert, Liu, Nagel, PRE 68, 011306 (2003) use to
/// find jamming: two spheres that overlap by a length h push each other with force h, and a wall pushes a sphere
/// likewise. FIRE minimises the energy (Bitzek, Koskinen, Gaehler, Moseler, Gumbsch, PRL 97, 170201, 2006). The result
/// does not depend on the number of threads, nor (except for rounding) on the unit of length.
class TileRelaxation {
public:
    explicit TileRelaxation(const TileSpheres& spheres);

    enum class Outcome {
        separated, ///< no overlap is above the allowed one
        balanced, ///< every sphere that carries force is in balance: the packing is jammed
        unfinished ///< the steps ran out
    };
    struct Goal {
        double allowed = 0; ///< overlaps up to this part of the sum of radii count as none
        double balance =
            1e-2; ///< forces count as balanced when net force (root mean square) / mean contact force is below this
        uint64_t max_steps = 20000;
    };
    /// What the last step measured.
    struct State {
        double worst_overlap = 0; ///< as part of the sum of radii
        double mean_overlap = 0; ///< over pairs that overlap, as part of the mean diameter
        uint64_t contacts = 0; ///< overlapping pairs (each counted twice) and overlaps with faces
        uint64_t steps = 0; ///< in all calls so far
    };

    /// Moves the spheres from their places, with their radii times `scale`. Throws Cancelled.
    Outcome relax(double scale, const Goal& goal, const Progress& progress);

    const State& state() const { return state_; }
    /// The spheres' places, in the order in which the spheres were given.
    std::vector<Imath::V3d> places() const;

private:
    struct alignas(32) Body {
        double x, y, z, r;
    };
    struct Vector {
        double x = 0, y = 0, z = 0;
    };
    struct Sums;
    struct Sheet;

    std::vector<Sheet> sheets_of(const std::vector<double>& radius, const std::vector<Imath::V3d>& place) const;
    void build_lists(double scale);
    Sums add_forces(double scale, uint64_t begin, uint64_t end);
    void push_off_walls(double scale, uint64_t body, Vector& force, Sums& sums) const;
    Sums all_forces(double scale);
    double advance(double dt, double keep, double along, double limit);

    Imath::V3d size_;
    double mean_radius_, skin_;
    std::vector<uint32_t> row_; ///< of each body; bodies are sorted by place
    std::vector<uint32_t> sheet_;
    std::vector<Body> body_;
    std::vector<Vector> velocity_, force_, listed_; ///< listed: the places when the lists were built
    std::vector<double> inverse_mass_;
    std::vector<uint64_t> starts_; ///< of each body's neighbours in neighbours_
    std::vector<uint32_t> neighbours_; ///< a body, and the number of its shift in the upper five bits
    std::array<Body, 27> shifts_;
    State state_;
};

} // namespace scree
