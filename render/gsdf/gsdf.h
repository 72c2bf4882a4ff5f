#pragma once

#include "render/gsdf/direction_grid.h"
#include "render/gsdf/encounter.h"
#include "render/materials/material.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace scree {

/// A direction or a place on the unit sphere in 32 bits, off by less than 8e-5 (octahedral map, Cigolle et al. 2014,
/// JCGT 3(2)).
struct PackedDirection {
    uint16_t u = 0, v = 0;

    PackedDirection() = default;
    explicit PackedDirection(const V3d& w);
    V3d unpack() const;
};

/// One path through a grain, from the frame of its encounter to where it left the bounding sphere.
struct GsdfRecord {
    PackedDirection point, direction;
    float length = 0; ///< of the way in the grain's material, in radii
    uint32_t events = 0; ///< scatterings at the surface
};

/// What a GSDF was made with and how far it can be trusted.
struct GsdfQuality {
    uint64_t paths = 0; ///< through the bounding sphere
    uint64_t lost = 0; ///< of them, given up on
    double density_error = 0; ///< estimated mean relative error of the directional density
    double mean_cosine = 0, mean_cosine_error = 0; ///< of all scattered paths, with its standard error
    double seconds = 0;
};

/// What is to be said when a GSDF is not as good as it should be; empty if nothing.
std::string doubt_of(const GsdfQuality& quality, double wanted_error);

/// The scattering of a grain averaged over its rotations (grain-scattering distribution function, Müller et al. 2016,
/// section 4).
///
/// With probability alpha0(q) a ray misses the grain in its bounding sphere; else it is scattered as one of the
/// recorded paths was. Paths are recorded without loss: absorption, tint and reflectance follow from a record's length
/// and events when rendering. Strata are equally wide in q = sin^2 beta_o.
///
/// The density of directions is tabulated over DirectionGrid from many more paths than are recorded. Sampling chooses a
/// cell by its mass, and a record of that cell says the rest; `density` follows the neighbours across a cell and
/// integrates over it to the same mass.
class Gsdf {
public:
    static constexpr uint32_t strata = 32, alpha_bins = 512;
    static constexpr uint32_t cells = DirectionGrid::cells;

    /// What is stored; see gsdf_file.h.
    struct Data {
        std::vector<float> alpha0; ///< alpha_bins values at the middles of bins of q
        std::vector<float> density; ///< strata * cells means over cells, per solid angle
        std::vector<uint32_t> first; ///< strata * cells + 1: where a cell's records begin
        std::vector<GsdfRecord> records;
        std::vector<Imath::C3f> weights; ///< of the records, for metals; else empty
        GsdfQuality quality;
    };
    /// Takes over data of the right sizes, the masses of every stratum summing to 1; every cell of positive mass has a
    /// record.
    explicit Gsdf(Data data);

    /// Probability that a ray misses the grain.
    double alpha0(double q) const;
    /// The mean over q: light from afar that passes straight through.
    double mean_alpha0() const;
    /// Whether no ray ever misses.
    bool always_met() const { return always_met_; }

    /// One of the two strata around q, chosen by u so that the scattering is interpolated linearly in q.
    static uint32_t stratum(double q, double u);
    /// Density of directions per solid angle; w is in the frame of the encounter. Integrates to 1.
    double density(uint32_t stratum, const V3d& w) const;
    /// The integral of `density` over a cell.
    double cell_mass(uint32_t stratum, uint32_t cell) const
    {
        return cell_density(stratum, cell) * DirectionGrid::area(cell);
    }
    /// The mean of `density` over a cell: what strategies are weighed by.
    double cell_density(uint32_t stratum, uint32_t cell) const { return data_.density[index(stratum, cell)]; }
    /// A cell with probability cell_mass.
    uint32_t sample_cell(uint32_t stratum, double u) const;
    /// A record's number: any of a cell's, by u.
    uint32_t pick(uint32_t stratum, uint32_t cell, double u) const;
    std::span<const GsdfRecord> records(uint32_t stratum, uint32_t cell) const;
    const GsdfRecord& record(uint32_t number) const { return data_.records[number]; }
    /// What a record's path keeps of light in a grain of this material and radius (in the material's units).
    Weight weight(uint32_t number, const Material& material, double radius) const;

    /// Probability that an encounter that is uniform in q falls into the stratum, given that it scatters.
    double stratum_mass(uint32_t stratum) const { return stratum_mass_[stratum]; }
    /// Mean cosine of the recorded scattering, for light from afar.
    double mean_cosine() const;
    const Data& data() const { return data_; }
    uint64_t bytes() const;

private:
    static size_t index(uint32_t stratum, uint32_t cell) { return static_cast<size_t>(stratum) * cells + cell; }

    Data data_;
    std::vector<float> shape_; // of cells: the mean over that of the interpolated density
    std::vector<float> cumulated_; // of masses, up to and with the cell, by stratum
    std::array<double, strata> stratum_mass_{};
    bool always_met_ = false;
};

} // namespace scree
