#include "packing/fill/list_fill.h"

#include "base/error.h"

#include <tbb/parallel_for.h>

namespace scree {

namespace {

/// Rows of a cell that are in the fill.
std::vector<uint64_t> rows_of(const ProceduralFill& fill, uint64_t cell)
{
    std::vector<uint64_t> rows;
    if (fill.kind(cell) == ProceduralFill::CellKind::outside) return rows;
    for (uint64_t row = 0; row < fill.tile().rows(); ++row) {
        if (fill.is_whole(cell, row)) rows.push_back(row);
    }
    return rows;
}

void append(const ProceduralFill& fill, uint64_t cell, const std::vector<uint64_t>& rows, ParticleFrame& frame)
{
    for (const uint64_t row : rows) {
        const ProceduralFill::Sphere sphere = fill.sphere(fill.id(cell, row));
        frame.position.push_back(sphere.centre);
        frame.radius.push_back(sphere.radius);
        frame.type.push_back(fill.tile().type[row]);
        frame.id.push_back(fill.id(cell, row));
    }
}

} // namespace

void list_fill(const ProceduralFill& fill, uint64_t batch, const std::function<void(const ParticleFrame&)>& take,
               const Progress& progress)
{
    const uint64_t cells = fill.cell_count();
    const uint64_t at_once = std::max<uint64_t>(1, batch / (4 * fill.tile().rows()));
    const auto empty = [&] {
        ParticleFrame frame;
        frame.has_ids = true;
        frame.domain = fill.domain().bounds();
        frame.origin = fill.origin();
        return frame;
    };
    ParticleFrame frame = empty();
    for (uint64_t first = 0; first < cells; first += at_once) {
        if (progress.cancelled()) throw Cancelled();
        progress.update("listing spheres", static_cast<double>(first) / static_cast<double>(cells));
        std::vector<std::vector<uint64_t>> rows(std::min(at_once, cells - first));
        tbb::parallel_for(size_t{0}, rows.size(), [&](size_t i) { rows[i] = rows_of(fill, first + i); });
        for (size_t i = 0; i < rows.size(); ++i) append(fill, first + i, rows[i], frame);
        if (frame.size() < batch) continue;
        take(frame);
        frame = empty();
    }
    take(frame);
}

} // namespace scree
