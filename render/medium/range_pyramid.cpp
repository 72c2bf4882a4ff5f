#include "render/medium/range_pyramid.h"

namespace scree {

namespace {

constexpr int64_t most_cells = int64_t{1} << 22; ///< of the first level

RangePyramid::Range join(const RangePyramid::Range& a, const RangePyramid::Range& b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }

template <class Each>
void for_each_cell(const std::array<int64_t, 3>& first, const std::array<int64_t, 3>& last, const Each& each)
{
    for (int64_t x = first[0]; x <= last[0]; ++x)
        for (int64_t y = first[1]; y <= last[1]; ++y)
            for (int64_t z = first[2]; z <= last[2]; ++z) each(x, y, z);
}

size_t index_of(const std::array<int64_t, 3>& size, int64_t x, int64_t y, int64_t z) { return static_cast<size_t>((x * size[1] + y) * size[2] + z); }

} // namespace

RangePyramid::RangePyramid(const BrickField& field, size_t plane) : background_{field.background[plane], field.background[plane]}
{
    if (field.bricks[0] == 0) return;
    // A brick is several cells where there is memory for them, else a cell is several bricks: up is the power of two of bricks along its edge.
    constexpr int64_t fine = 4; // cells of a brick along an axis
    const std::array<int64_t, 3> bricks{field.bricks[0], field.bricks[1], field.bricks[2]};
    const int64_t parts = fine * fine * fine * bricks[0] * bricks[1] * bricks[2] <= most_cells ? fine : 1;
    int up = 0;
    const auto cells = [&](size_t k) { return ((bricks[k] * parts - 1) >> up) + 1; };
    while (cells(0) * cells(1) * cells(2) > most_cells) ++up;
    const int64_t wide = BrickField::width / parts; // of a part, in cells of the field
    width_ = static_cast<double>(wide) * static_cast<double>(int64_t{1} << up);

    Level level{{cells(0), cells(1), cells(2)}, {}};
    constexpr Range none{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
    level.cells.assign(static_cast<size_t>(level.size[0] * level.size[1] * level.size[2]), none);
    const auto range_of = [&](const BrickField::Content& content, int64_t x, int64_t y, int64_t z) -> Range {
        if (content.constant || parts == 1) return {content.low[plane], content.high[plane]};
        const float* values = field.values.data() + content.offset + plane * BrickField::corners;
        Range range = none;
        for_each_cell({x * wide, y * wide, z * wide}, {(x + 1) * wide, (y + 1) * wide, (z + 1) * wide}, [&](int64_t i, int64_t j, int64_t k) {
            const float value = values[(i * BrickField::stride + j) * BrickField::stride + k];
            range = join(range, {value, value});
        });
        return range;
    };
    for_each_cell({0, 0, 0}, {bricks[0] - 1, bricks[1] - 1, bricks[2] - 1}, [&](int64_t x, int64_t y, int64_t z) {
        const BrickField::Region region = field.find({static_cast<int32_t>(x), static_cast<int32_t>(y), static_cast<int32_t>(z)});
        for_each_cell({0, 0, 0}, {parts - 1, parts - 1, parts - 1}, [&](int64_t i, int64_t j, int64_t k) {
            const Range range = region.content < 0 ? background_ : range_of(field.contents[static_cast<size_t>(region.content)], i, j, k);
            Range& cell = level.cells[index_of(level.size, (x * parts + i) >> up, (y * parts + j) >> up, (z * parts + k) >> up)];
            cell = join(cell, range);
        });
    });
    levels_.push_back(std::move(level));
    while (levels_.back().cells.size() > 1) {
        const Level& below = levels_.back();
        Level above{{(below.size[0] + 1) / 2, (below.size[1] + 1) / 2, (below.size[2] + 1) / 2}, {}};
        above.cells.assign(static_cast<size_t>(above.size[0] * above.size[1] * above.size[2]), none);
        for_each_cell({0, 0, 0}, {below.size[0] - 1, below.size[1] - 1, below.size[2] - 1}, [&](int64_t x, int64_t y, int64_t z) {
            Range& cell = above.cells[index_of(above.size, x / 2, y / 2, z / 2)];
            cell = join(cell, below.cells[index_of(below.size, x, y, z)]);
        });
        levels_.push_back(std::move(above));
    }
}

RangePyramid::Range RangePyramid::over(const Imath::Box3d& box) const
{
    if (levels_.empty()) return background_;
    // The cells of the level are as wide as the box at least: it meets two of them along an axis at most.
    const V3d extent = box.max - box.min;
    const double longest = std::max({extent.x, extent.y, extent.z});
    size_t number = 0;
    double width = width_;
    while (number + 1 < levels_.size() && width < longest) {
        width *= 2;
        ++number;
    }
    const Level& level = levels_[number];
    std::array<int64_t, 3> first, last;
    bool beyond = false;
    for (int k = 0; k < 3; ++k) {
        const auto a = static_cast<size_t>(k);
        const double lo = std::floor(box.min[k] / width), hi = std::floor(box.max[k] / width), end = static_cast<double>(level.size[a]) - 1;
        if (!(lo <= end && hi >= 0)) return background_;
        beyond = beyond || lo < 0 || hi > end;
        first[a] = static_cast<int64_t>(std::max(lo, 0.0));
        last[a] = static_cast<int64_t>(std::min(hi, end));
    }
    Range range = level.cells[index_of(level.size, first[0], first[1], first[2])];
    for_each_cell(first, last, [&](int64_t x, int64_t y, int64_t z) { range = join(range, level.cells[index_of(level.size, x, y, z)]); });
    return beyond ? join(range, background_) : range;
}

uint64_t RangePyramid::bytes() const
{
    uint64_t sum = 0;
    for (const Level& level : levels_) sum += level.cells.size() * sizeof(Range);
    return sum;
}

} // namespace scree
