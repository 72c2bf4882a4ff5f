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

/// One path through a grain: where and in which direction it left the bounding sphere, in the frame of its Encounter.
struct GsdfRecord {
    PackedDirection point, direction; ///< x_i and omega_i in the paper
    float length = 0; ///< of the path inside the grain's material, in radii
    uint32_t events = 0; ///< scatterings at the surface
};

/// How a GSDF was made and how accurate it is.
struct GsdfQuality {
    uint64_t paths = 0; ///< through the bounding sphere
    uint64_t lost = 0; ///< of these, given up
    double density_error = 0; ///< estimated mean relative error of the directional density
    double mean_cosine = 0, mean_cosine_error = 0; ///< of all scattered paths, with its standard error
    double seconds = 0;
};

/// A warning about a GSDF that lost many paths or misses the wanted error; empty if there is nothing to warn about.
std::string doubt_of(const GsdfQuality& quality, double wanted_error);

/// The scattering of a grain averaged over its rotations: the grain-scattering distribution function f_g of Müller et
/// al. 2016, section 4.
///
/// With probability alpha0(q), the paper's alpha_g^0(beta_o), a ray in the bounding sphere misses the grain; else it is
/// scattered like one of the recorded paths, which are draws of p_g(x_i, omega_i | beta_o). Paths are recorded without
/// loss: absorption, tint and reflectance follow from a record's length and events when rendering. So the paper's
/// alpha_g^+(beta_o) is (1 - alpha0(q)) times the mean of weight() over the records. Strata are equally wide in
/// q = sin^2 beta_o.
///
/// The density of directions (p_g^{omega_i} in the paper, here of the lossless grain) is tabulated over DirectionGrid
/// from many more paths than are recorded. Sampling chooses a cell by its mass, then one of that cell's records.
/// density() interpolates between neighbouring cells and integrates over each cell to the cell's mass.
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
    /// data: of the sizes above; the masses of each stratum sum to 1, and each cell of positive mass has a record.
    explicit Gsdf(Data data);

    /// alpha_g^0(beta_o) in the paper: probability that a ray misses the grain; q = sin^2 beta_o.
    double alpha0(double q) const;
    /// Mean of alpha0 over q: the share of light from far away that passes straight through.
    double mean_alpha0() const;
    /// Whether no ray ever misses.
    bool always_met() const { return always_met_; }

    /// One of the two strata around q, chosen by u so that the scattering is interpolated linearly in q.
    static uint32_t stratum(double q, double u);
    /// Density of directions per solid angle, p_g^{omega_i}(w | beta_o) of the lossless grain; integrates to 1. w:
    /// omega_i in the frame of the Encounter.
    double density(uint32_t stratum, const V3d& w) const;
    /// The integral of `density` over a cell.
    double cell_mass(uint32_t stratum, uint32_t cell) const
    {
        return cell_density(stratum, cell) * DirectionGrid::area(cell);
    }
    /// The mean of `density` over a cell; weighs sampling strategies against each other.
    double cell_density(uint32_t stratum, uint32_t cell) const { return data_.density[index(stratum, cell)]; }
    /// A cell with probability cell_mass.
    uint32_t sample_cell(uint32_t stratum, double u) const;
    /// The number of one of the cell's records, each equally likely; u in 0..1.
    uint32_t pick(uint32_t stratum, uint32_t cell, double u) const;
    std::span<const GsdfRecord> records(uint32_t stratum, uint32_t cell) const;
    const GsdfRecord& record(uint32_t number) const { return data_.records[number]; }
    /// The share of light that a record's path keeps in a grain of this material and radius (in the material's units).
    Weight weight(uint32_t number, const Material& material, double radius) const;

    /// Probability that an encounter that is uniform in q falls into the stratum, given that it scatters.
    double stratum_mass(uint32_t stratum) const { return stratum_mass_[stratum]; }
    /// Mean cosine of the recorded scattering, for light from far away.
    double mean_cosine() const;
    const Data& data() const { return data_; }
    uint64_t bytes() const;

private:
    static size_t index(uint32_t stratum, uint32_t cell) { return static_cast<size_t>(stratum) * cells + cell; }

    Data data_;
    std::vector<float> shape_; // per cell: its mean density over the mean of the interpolated density
    std::vector<float> cumulated_; // sums of masses within a stratum, up to and including the cell
    std::array<double, strata> stratum_mass_{};
    bool always_met_ = false;
};

} // namespace scree
