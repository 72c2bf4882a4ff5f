#include "render/media/brick_field.h"

namespace scree {

std::array<double, 3> BrickField::at(const V3d& p) const
{
    std::array<int32_t, 3> brick{};
    bool inside = bricks[0] > 0;
    for (int k = 0; k < 3 && inside; ++k) {
        inside = p[k] >= support.min[k] && p[k] <= support.max[k];
        if (inside)
            brick[static_cast<size_t>(k)] =
                std::min(static_cast<int32_t>(p[k] / width), bricks[static_cast<size_t>(k)] - 1);
    }
    const Region region = inside ? find(brick) : Region{};
    if (region.content < 0) return {double{background[0]}, double{background[1]}, double{background[2]}};
    const Content& content = contents[static_cast<size_t>(region.content)];
    std::array<double, 3> result{};
    for (size_t plane = 0; plane < static_cast<size_t>(planes); ++plane)
        result[plane] = content.constant ? double{values[content.offset + plane]}
                                         : at_brick(content.offset + plane * corners,
                                                    {brick[0] * width, brick[1] * width, brick[2] * width}, p);
    return result;
}

uint64_t BrickField::bytes() const
{
    return contents.capacity() * sizeof(Content) + values.capacity() * sizeof(float) +
           root.capacity() * sizeof(uint32_t) + nodes.capacity() * sizeof(nodes[0]);
}

} // namespace scree
