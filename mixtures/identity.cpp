#include "mixtures/identity.h"

#include "base/hash.h"

#include <cmath>
#include <numbers>

namespace scree {

Imath::Quatd rotation_of_id(uint64_t id)
{
    constexpr uint64_t rotation_seed = 0x726f74617465ull; // "rotate": independent of every stream that chooses types
    const double u = unit_double(hash_index(id, rotation_seed, 0));
    const double a = 2 * std::numbers::pi * unit_double(hash_index(id, rotation_seed, 1));
    const double b = 2 * std::numbers::pi * unit_double(hash_index(id, rotation_seed, 2));
    const double s = std::sqrt(1 - u), c = std::sqrt(u);
    return {c * std::cos(b), s * std::sin(a), s * std::cos(a), c * std::sin(b)};
}

} // namespace scree
