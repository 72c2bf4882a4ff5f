#include "render/trace/world.h"

#include "mixtures/identity.h"

#include <array>

namespace scree {

namespace {

/// Rows are the images of the axes (Imath multiplies row vectors from the left).
Imath::M33d to_matrix(const Imath::Quatd& q)
{
    const double w = q.r, x = q.v.x, y = q.v.y, z = q.v.z;
    return {1 - 2 * (y * y + z * z), 2 * (x * y + w * z),     2 * (x * z - w * y),
            2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x),
            2 * (x * z + w * y),     2 * (y * z - w * x),     1 - 2 * (x * x + y * y)};
}

/// Cached, as a path returns to the same grain several times. The rotation of an id depends on the id alone.
const Imath::M33d& recent_rotation(uint64_t id)
{
    struct Entry {
        uint64_t id = 0;
        bool known = false;
        Imath::M33d rotation;
    };
    thread_local std::array<Entry, 64> recent;
    Entry& entry = recent[id % recent.size()];
    if (!entry.known || entry.id != id) entry = {id, true, to_matrix(rotation_of_id(id))};
    return entry.rotation;
}

} // namespace

Imath::M33d World::rotation(uint64_t grain) const
{
    if (grains.orientation.empty()) return recent_rotation(id(grain));
    const Imath::Quatf& q = grains.orientation[grain - grains.analytic_count];
    return to_matrix(Imath::Quatd(q.r, q.v.x, q.v.y, q.v.z));
}

} // namespace scree
