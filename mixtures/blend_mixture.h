#pragma once

#include "mixtures/mixture.h"

#include <memory>
#include <vector>

namespace scree {

/// One mixture, `by`, chooses for each sphere which of the other mixtures decides its type.
class BlendMixture final : public Mixture {
public:
    /// The types of `by` are indices into `mixtures`.
    BlendMixture(std::unique_ptr<Mixture> by, std::vector<std::unique_ptr<Mixture>> mixtures)
        : by_(std::move(by)), mixtures_(std::move(mixtures))
    {
    }

    uint32_t type(uint64_t index, const Imath::V3f& position) const override
    {
        return mixtures_[by_->type(index, position)]->type(index, position);
    }

    std::optional<std::set<uint32_t>> possible_types() const override
    {
        const auto chosen = by_->possible_types();
        std::set<uint32_t> all;
        for (uint32_t k = 0; k < mixtures_.size(); ++k) {
            if (chosen && !chosen->contains(k)) continue;
            const auto types = mixtures_[k]->possible_types();
            if (!types) return std::nullopt;
            all.insert(types->begin(), types->end());
        }
        return all;
    }

private:
    std::unique_ptr<Mixture> by_;
    std::vector<std::unique_ptr<Mixture>> mixtures_;
};

/// The mixture of one tile, for a fill that repeats the tile: sphere index = copy * size + row.
class TiledMixture final : public Mixture {
public:
    TiledMixture(std::unique_ptr<Mixture> tile, uint64_t size) : tile_(std::move(tile)), size_(size) {}

    uint32_t type(uint64_t index, const Imath::V3f& position) const override
    {
        return tile_->type(index % size_, position);
    }
    std::optional<std::set<uint32_t>> possible_types() const override { return tile_->possible_types(); }

private:
    std::unique_ptr<Mixture> tile_;
    uint64_t size_;
};

} // namespace scree
