#pragma once

#include "mixtures/mixture.h"
#include "mixtures/sphere_ids.h"

#include <span>
#include <vector>

namespace scree {

/// Every sphere draws its type independently, by the hash of its id; the weights are fractions by number.
///
/// u = unit_double(hash_index(id, seed, stream)); the choice is the first type whose cumulative weight (over the sum of
/// all weights) is above u. The sums are in double, from the first weight on.
class RandomMixture final : public Mixture {
public:
    /// types[k] has weight weights[k]: finite, not below 0, not all 0. Throws std::invalid_argument.
    RandomMixture(std::vector<uint32_t> types, std::span<const double> weights, uint64_t seed, uint64_t stream,
                  SphereIds ids);

    uint32_t type(uint64_t index, const Imath::V3f& position) const override;
    std::optional<std::set<uint32_t>> possible_types() const override
    {
        return std::set<uint32_t>(types_.begin(), types_.end());
    }

private:
    uint64_t key_;
    SphereIds ids_;
    std::vector<double> below_; // cumulative weights over their sum, without the last one
    std::vector<uint32_t> types_;
};

/// For every sphere the index k of its type, such that the total volumes of the types are proportional to the weights.
///
/// With independent draws the volume fractions equal the weights only on average: where few spheres hold most of the
/// volume (log-normal radii, sigma 1: a hundred of a million) the fractions scatter by several per cent. So this
/// function visits the spheres from the largest to the smallest, equal ones in the order of their hash. Let V be the
/// volume of the spheres up to and including sphere i. Sphere i draws by its hash among the types that lack volume; the
/// probability of type k is proportional to the lacking volume, weight_k V - volume_k. A type that sphere i would
/// overfill for good (volume_k + v_i above weight_k times the volume of all spheres) is left out while there are
/// others. Every size class is mixed by the weights, no type depends on the position, and the volumes are exact to
/// about the smallest sphere.
///
/// radii, ids: one of each per sphere; weights: as for RandomMixture, at most 1024. Throws std::invalid_argument.
std::vector<uint32_t> choose_by_volume(std::span<const float> radii, const SphereIds& ids,
                                       std::span<const double> weights, uint64_t seed, uint64_t stream);

} // namespace scree
