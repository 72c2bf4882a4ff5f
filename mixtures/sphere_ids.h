#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace scree {

/// The ids of the spheres of a frame by row; 16 bytes in all where they are consecutive, else shared between mixtures.
class SphereIds {
public:
    /// Every sphere's index is its id.
    SphereIds() = default;

    explicit SphereIds(const std::vector<uint64_t>& ids)
    {
        if (ids.empty()) return;
        first_ = ids[0];
        for (size_t i = 1; i < ids.size(); ++i) {
            if (ids[i] == first_ + i) continue;
            ids_ = std::make_shared<const std::vector<uint64_t>>(ids);
            return;
        }
    }

    uint64_t operator[](uint64_t row) const { return ids_ ? (*ids_)[row] : first_ + row; }

private:
    uint64_t first_ = 0;
    std::shared_ptr<const std::vector<uint64_t>> ids_;
};

} // namespace scree
