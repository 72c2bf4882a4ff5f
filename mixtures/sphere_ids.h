#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace scree {

/// The ids of a frame's spheres by row; stores only the first of consecutive ids, otherwise copies share the list.
class SphereIds {
public:
    /// The id of every sphere is its index.
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
