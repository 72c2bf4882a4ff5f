#pragma once

#include "mixtures/mixture.h"
#include "mixtures/sphere_ids.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// The concentration of a grain type in space: a float grid of an OpenVDB file.
struct ConcentrationField {
    uint32_t type = 0;
    std::filesystem::path file;
    std::string grid; ///< its name; empty: the file's first float grid
};

/// Each sphere draws its type by the hash of its id; the concentrations at its centre are the probabilities.
///
/// c_k: interpolated trilinearly between voxel centres; a negative or non-finite value counts as 0. With a `rest` type,
/// type k has probability c_k and the rest 1 - sum c; where the sum is above 1, type k has c_k / sum. Without a `rest`
/// type, type k has c_k / sum; where all c are 0, the first field's type is chosen.
/// u = unit_double(hash_index(id, seed, stream)) chooses as in RandomMixture.
class GridMixture final : public Mixture {
public:
    struct Options {
        std::vector<ConcentrationField> fields; ///< at least one
        std::optional<uint32_t> rest;
        uint64_t seed = 0, stream = 0;
    };

    /// origin: the point that positions are relative to. Throws InputError naming the file.
    GridMixture(const Options& options, SphereIds ids, const Imath::V3d& origin);
    ~GridMixture() override;

    uint32_t type(uint64_t index, const Imath::V3f& position) const override;
    std::optional<std::set<uint32_t>> possible_types() const override;

private:
    struct Fields;
    std::unique_ptr<const Fields> fields_;
    SphereIds ids_;
    Imath::V3d origin_;
    uint64_t key_;
};

} // namespace scree
