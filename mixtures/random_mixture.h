#pragma once

#include "mixtures/mixture.h"
#include "mixtures/sphere_ids.h"

#include <span>
#include <vector>

namespace scree {

/// Every sphere draws its type by itself, by the hash of its id: the fractions are by number.
///
/// u = unit_double(hash_index(id, seed, stream)); the choice is the first whose sum of weights (over the sum of all) is
/// above u. The sums are taken in double from the first weight on.
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
    std::vector<double> below_; // sums of weights, without the last one
    std::vector<uint32_t> types_;
};

/// For every sphere the place k of its type, so that the types' volumes are as their weights.
///
/// What is drawn sphere by sphere has the weights as its volume fractions only on average: where few spheres hold most
/// of the volume (log-normal radii, sigma 1: a hundred of a million) they scatter by several per cent. So spheres are
/// gone through from the largest to the smallest (equal ones in the order of their hash), and sphere i, with V the
/// volume up to and with it, draws by its hash among the types that lack volume, each with a chance proportional to
/// what it lacks, weight_k V - volume_k; types it would overfill for good (volume_k + v_i above weight_k times the
/// volume of all) are left out while there are others. Every size class is mixed by the weights, no type depends on the
/// place, and the sums are right to about the smallest sphere.
///
/// radii and ids: of the spheres; weights as for RandomMixture, at most 1024. Throws std::invalid_argument.
std::vector<uint32_t> choose_by_volume(std::span<const float> radii, const SphereIds& ids,
                                       std::span<const double> weights, uint64_t seed, uint64_t stream);

} // namespace scree
