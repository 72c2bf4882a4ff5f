#include "render/media/clearance_field.h"

#include "base/error.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace scree {

namespace {

constexpr double least_square = 8; ///< squared voxels: below this the interpolation is not tried
constexpr size_t entry_bits = 21;
/// part of the square that the interpolation may lose in the middle of an octant; elsewhere slightly more
constexpr double most_lost = 0.03;

float round_down(double x)
{
    const auto f = static_cast<float>(x);
    return double{f} <= x ? f : std::nextafter(f, 0.0f);
}

} // namespace

ClearanceField::ClearanceField(std::span<const TriangleView> meshes, const Imath::Box3d& box, const Progress& progress,
                               int voxels)
{
    if (voxels < 1 || voxels > 1024) throw InputError("clearance field", fmt::format("{} voxels", voxels), "1 to 1024");
    const V3d extent = box.size();
    const double longest = std::max({extent.x, extent.y, extent.z});
    if (box.isEmpty() || !(longest > 0) || !std::isfinite(longest))
        throw InputError("clearance field", "a box that is empty or infinite", "a finite box");
    scale_ = std::ldexp(1.0, -std::ilogb(longest));
    const V3d lo = box.min * scale_, hi = box.max * scale_;
    const double farthest =
        std::max({std::abs(lo.x), std::abs(lo.y), std::abs(lo.z), std::abs(hi.x), std::abs(hi.y), std::abs(hi.z)});
    if (!(farthest < 0x1p50))
        throw InputError("clearance field", "a box that is 2^50 times its size from the origin",
                         "a box that double precision can distinguish from a point");
    origin_ = box.min;
    voxel_ = longest / voxels;
    per_length_ = 1 / voxel_;
    // Rounding changes the interpolation by less than 2^-46 of the corner values, which are similar wherever it is
    // used.
    rounded_voxel_ = voxel_ * (1 - 0x1p-40);
    for (int k = 0; k < 3; ++k)
        size_[static_cast<size_t>(k)] = std::clamp(static_cast<int>(std::ceil(extent[k] * per_length_)), 1, voxels);
    step_[1] = static_cast<size_t>(size_[2]) + 1;
    step_[0] = step_[1] * (static_cast<size_t>(size_[1]) + 1);
    tree_ = TriangleTree(meshes, scale_, progress);
    if (tree_.empty())
        largest_ = std::numeric_limits<double>::infinity();
    else
        fill_squares(progress);
    progress.update("clearance", 1);
}

double ClearanceField::near(const V3d& place, int x, int y, int z, bool is_rough, double least) const
{
    std::atomic<uint64_t>& word =
        entries_[static_cast<size_t>(x) * step_[0] + static_cast<size_t>(y) * step_[1] + static_cast<size_t>(z)];
    uint64_t packed = word.load(std::memory_order_relaxed);
    if (packed == 0) {
        const V3d middle = (origin_ + V3d(x + 0.5, y + 0.5, z + 0.5) * voxel_) * scale_;
        // Half a diagonal plus the rounding of points and lattice, valid up to 2^50 boxes from the origin.
        const double radius = (std::sqrt(0.75) * (1 + 0x1p-20)) * voxel_ * scale_ +
                              0x1p-48 * (std::abs(middle.x) + std::abs(middle.y) + std::abs(middle.z));
        const TriangleTree::Entries found = tree_.entries(middle, radius);
        packed = uint64_t{1} << 63;
        for (size_t k = 0; k < found.size(); ++k) packed |= uint64_t{found[k]} << (entry_bits * k);
        word.store(packed, std::memory_order_relaxed);
    }
    constexpr uint64_t mask = (uint64_t{1} << entry_bits) - 1;
    TriangleTree::Entries from;
    for (size_t k = 0; k < from.size(); ++k) from[k] = static_cast<uint32_t>(packed >> (entry_bits * k) & mask);
    return (is_rough ? tree_.rough_distance(place * scale_, from, least * scale_)
                     : tree_.distance(place * scale_, from)) /
           scale_;
}

void ClearanceField::fill_squares(const Progress& progress)
{
    const std::array<size_t, 3> count{static_cast<size_t>(size_[0]) + 1, static_cast<size_t>(size_[1]) + 1,
                                      static_cast<size_t>(size_[2]) + 1};
    squares_.assign(count[0] * count[1] * count[2], 0);
    entries_ = std::make_unique<std::atomic<uint64_t>[]>(squares_.size());
    // the nearest triangle point of each lattice point, in voxels from the origin
    std::vector<V3f> nearest(squares_.size());
    const double per_voxel = per_length_ / scale_;
    const V3d first = origin_ * scale_;
    // Lattice points are rounded, and a point near a voxel's face may be assigned to the neighbouring voxel.
    const double rounding =
        0x1p-40 + 0x1p-50 * per_voxel * std::max({std::abs(first.x), std::abs(first.y), std::abs(first.z), 1.0});
    tbb::parallel_for(size_t{0}, count[0] * count[1], [&](size_t line) {
        if (progress.cancelled()) return;
        const size_t x = line / count[1], y = line % count[1];
        uint32_t block = TriangleTree::none;
        for (size_t z = 0; z < count[2]; ++z) {
            const V3d index(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)),
                place = (origin_ + index * voxel_) * scale_;
            const double distance = std::max(0.0, tree_.distance(place, block) * per_voxel - rounding);
            squares_[line * count[2] + z] = round_down(distance * distance * (1 - 0x1p-50));
            nearest[line * count[2] + z] = V3f((tree_.nearest_point(block, place) - first) * per_voxel);
        }
    });
    if (progress.cancelled()) throw Cancelled();

    // Voxels that need the tree get a negative sign. It is set afterwards, because other voxels read these values here.
    std::vector<uint8_t> tight(squares_.size());
    tbb::parallel_for(size_t{0}, (count[0] - 1) * (count[1] - 1), [&](size_t line) {
        if (progress.cancelled()) return;
        const size_t x = line / (count[1] - 1), y = line % (count[1] - 1);
        for (size_t z = 0; z + 1 < count[2]; ++z) {
            const size_t at = x * step_[0] + y * step_[1] + z;
            std::array<V3f, 8> feet;
            float least = std::numeric_limits<float>::infinity();
            for (size_t k = 0; k < 8; ++k) {
                const size_t corner = at + (k & 1 ? step_[0] : 0) + (k & 2 ? step_[1] : 0) + (k >> 2);
                least = std::min(least, squares_[corner]);
                feet[k] = nearest[corner];
            }
            if (!(least >= least_square)) continue;
            bool good = true;
            for (size_t octant = 0; octant < 8 && good; ++octant) {
                const V3d t(octant & 1 ? 0.75 : 0.25, octant & 2 ? 0.75 : 0.25, octant & 4 ? 0.75 : 0.25);
                const V3f p(V3d(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)) + t);
                float above = std::numeric_limits<float>::infinity();
                for (const V3f& foot : feet) above = std::min(above, (foot - p).length2());
                good = interpolate(&squares_[at], t.x, t.y, t.z) >= double{above} * (1 - most_lost);
            }
            tight[at] = good;
        }
    });
    if (progress.cancelled()) throw Cancelled();
    largest_ = (std::sqrt(double{*std::ranges::max_element(squares_)}) + std::sqrt(3.0)) *
               voxel_; // a point may lie between lattice points
    for (size_t i = 0; i < squares_.size(); ++i)
        if (!tight[i]) squares_[i] = -squares_[i];
}

} // namespace scree
