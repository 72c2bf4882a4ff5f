#pragma once

#include "mixtures/mixture.h"

namespace scree {

/// One grain type for all spheres.
class SingleMixture final : public Mixture {
public:
    explicit SingleMixture(uint32_t type) : type_(type) {}
    uint32_t type(uint64_t, const Imath::V3f&) const override { return type_; }
    std::optional<std::set<uint32_t>> possible_types() const override { return std::set{type_}; }

private:
    uint32_t type_;
};

} // namespace scree
