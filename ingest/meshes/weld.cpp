#include "ingest/meshes/weld.h"

#include <bit>
#include <limits>

namespace scree {

namespace {

uint64_t hash_of(const Imath::V3d& p)
{
    uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
        hash ^= std::bit_cast<uint64_t>(p[axis] + 0.0); // + 0.0 turns -0 into 0
        hash *= 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return hash;
}

} // namespace

std::vector<uint32_t> first_at_same_position(const std::vector<Imath::V3d>& positions)
{
    constexpr uint32_t none = std::numeric_limits<uint32_t>::max();
    const size_t slots = std::bit_ceil(2 * positions.size() + 1);
    std::vector<uint32_t> table(slots, none);
    std::vector<uint32_t> first(positions.size());
    for (size_t i = 0; i < positions.size(); ++i) {
        size_t slot = hash_of(positions[i]) & (slots - 1);
        while (table[slot] != none && positions[table[slot]] != positions[i]) slot = (slot + 1) & (slots - 1);
        if (table[slot] == none) table[slot] = static_cast<uint32_t>(i);
        first[i] = table[slot];
    }
    return first;
}

} // namespace scree
