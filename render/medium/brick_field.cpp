#include "render/medium/brick_field.h"

namespace scree {

std::array<double, 3> BrickField::at(const V3d& p) const
{
    std::array<int32_t, 3> brick{};
    bool inside = bricks[0] > 0;
    for (int k = 0; k < 3 && inside; ++k) {
        inside = p[k] >= support.min[k] && p[k] <= support.max[k];
        if (inside) brick[static_cast<size_t>(k)] = std::min(static_cast<int32_t>(p[k] / width), bricks[static_cast<size_t>(k)] - 1);
    }
    const Region region = inside ? find(brick) : Region{};
    if (region.content < 0) return {double{background[0]}, double{background[1]}, double{background[2]}};
    const Content& content = contents[static_cast<size_t>(region.content)];
    std::array<double, 3> result{};
    for (size_t plane = 0; plane < static_cast<size_t>(planes); ++plane)
        result[plane] = content.constant ? double{values[content.offset + plane]}
                                         : at_brick(content.offset + plane * corners, {brick[0] * width, brick[1] * width, brick[2] * width}, p);
    return result;
}

uint64_t BrickField::bytes() const
{
    return contents.capacity() * sizeof(Content) + values.capacity() * sizeof(float) + root.capacity() * sizeof(uint32_t) + nodes.capacity() * sizeof(nodes[0]);
}

bool FieldRay::clip(const Imath::Box3d& box, double& t0, double& t1) const
{
    for (int k = 0; k < 3; ++k) {
        if (step[static_cast<size_t>(k)] == 0) {
            if (!(o[k] >= box.min[k] && o[k] <= box.max[k])) return false;
            continue;
        }
        const double a = (box.min[k] - o[k]) * inverse[k], b = (box.max[k] - o[k]) * inverse[k];
        t0 = std::max(t0, std::min(a, b));
        t1 = std::min(t1, std::max(a, b));
    }
    return t0 < t1;
}

} // namespace scree
