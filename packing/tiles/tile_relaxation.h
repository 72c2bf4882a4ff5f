#pragma once

#include "base/progress.h"
#include "packing/tiles/tile_spheres.h"

#include <array>
#include <cstdint>
#include <vector>

namespace scree {

/// Soft spheres in a periodic cuboid, moved until they do not overlap or until their forces balance.
///
/// Harmonic repulsion of equal springs, as O'Hern, Silbert, Liu, Nagel, PRE 68, 011306 (2003) use to find jamming: two
/// spheres that overlap by a length h push each other with force h, and so do walls. Minimised by FIRE (Bitzek,
/// Koskinen, Gaehler, Moseler, Gumbsch, PRL 97, 170201, 2006). The result does not depend on the number of threads, nor
/// on the unit of length but for rounding.
class TileRelaxation {
public:
    explicit TileRelaxation(const TileSpheres& spheres);

    enum class Outcome {
        separated, ///< no overlap above the one allowed
        balanced, ///< every sphere that carries force is in balance: this is jammed
        unfinished ///< steps ran out
    };
    struct Goal {
        double allowed = 0; ///< overlap, as part of the sum of radii, that counts as none
        double balance =
            1e-2; ///< the net force (root mean square) over the mean force of contacts that counts as balance
        uint64_t max_steps = 20000;
    };
    /// What the last step saw.
    struct State {
        double worst_overlap = 0; ///< as part of the sum of radii
        double mean_overlap = 0; ///< over pairs that overlap, as part of the mean diameter
        uint64_t contacts = 0; ///< pairs (each twice) and faces that overlap
        uint64_t steps = 0; ///< so far, all calls
    };

    /// Moves the spheres, their radii times `scale`, from where they are. Throws Cancelled.
    Outcome relax(double scale, const Goal& goal, const Progress& progress);

    const State& state() const { return state_; }
    /// Where the spheres are, in the order they were given in.
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
    std::vector<uint32_t> row_; ///< of each body: bodies are sorted by place
    std::vector<uint32_t> sheet_;
    std::vector<Body> body_;
    std::vector<Vector> velocity_, force_, listed_; ///< listed: where they were when the lists were built
    std::vector<double> inverse_mass_;
    std::vector<uint64_t> starts_; ///< of each body's neighbours
    std::vector<uint32_t> neighbours_; ///< body, and the number of its shift in the upper five bits
    std::array<Body, 27> shifts_;
    State state_;
};

} // namespace scree
