#include "mixtures/grid_mixture.h"

#include "base/error.h"
#include "base/hash.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <cmath>

namespace scree {

struct GridMixture::Fields {
    struct Field {
        openvdb::FloatGrid::ConstPtr grid;
        uint32_t type;
    };
    std::vector<Field> fields;
    std::optional<uint32_t> rest;
};

namespace {

openvdb::FloatGrid::ConstPtr read_field(const ConcentrationField& field)
{
    const std::string place = field.file.string();
    try {
        openvdb::io::File file(place);
        file.open();
        std::vector<std::string> names;
        for (auto name = file.beginName(); name != file.endName(); ++name) {
            names.push_back(name.gridName());
            if (!field.grid.empty() && name.gridName() != field.grid) continue;
            if (const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name.gridName()))) return grid;
            if (!field.grid.empty())
                throw InputError(place, "the grid '" + field.grid + "', which is not a float grid", "a float grid");
        }
        if (field.grid.empty()) throw InputError(place, "no float grid", "a concentration as an OpenVDB float grid");
        throw InputError(place, "no grid '" + field.grid + "'",
                         fmt::format("one of the file's grids: {}", fmt::join(names, ", ")));
    } catch (const openvdb::Exception& failure) {
        throw InputError(place, failure.what(), "an OpenVDB file with a float grid");
    }
}

double sample(const openvdb::FloatGrid& grid, const openvdb::Vec3d& place)
{
    // The accessor is not registered with its tree, so it needs no lock and no allocation; it belongs to this thread.
    const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false> accessor(grid.constTree());
    const openvdb::Vec3d voxel = grid.worldToIndex(place);
    constexpr double limit = 1 << 30; // voxel indices have 32 bits
    if (!(std::abs(voxel.x()) < limit && std::abs(voxel.y()) < limit && std::abs(voxel.z()) < limit)) return 0;
    const float value = openvdb::tools::BoxSampler::sample(accessor, voxel);
    return value > 0 && std::isfinite(value) ? value : 0;
}

} // namespace

GridMixture::GridMixture(const Options& options, SphereIds ids, const Imath::V3d& origin)
    : ids_(std::move(ids)), origin_(origin), key_(hash_key(options.seed, options.stream))
{
    openvdb::initialize();
    auto fields = std::make_unique<Fields>();
    for (const ConcentrationField& field : options.fields) fields->fields.push_back({read_field(field), field.type});
    fields->rest = options.rest;
    fields_ = std::move(fields);
}

GridMixture::~GridMixture() = default;

uint32_t GridMixture::type(uint64_t index, const Imath::V3f& position) const
{
    const openvdb::Vec3d place(origin_.x + position.x, origin_.y + position.y, origin_.z + position.z);
    // The values of the first fields are kept on the stack; further fields are sampled twice.
    constexpr size_t kept = 16;
    double values[kept];
    double sum = 0;
    for (size_t k = 0; k < fields_->fields.size(); ++k) {
        const double value = sample(*fields_->fields[k].grid, place);
        if (k < kept) values[k] = value;
        sum += value;
    }
    const double all = fields_->rest && sum < 1 ? 1 : sum;
    const double u = unit_double(hash_with_key(ids_[index], key_)) * all;
    double below = 0;
    std::optional<uint32_t> last;
    for (size_t k = 0; k < fields_->fields.size(); ++k) {
        const double value = k < kept ? values[k] : sample(*fields_->fields[k].grid, place);
        if (value == 0) continue;
        last = fields_->fields[k].type;
        below += value;
        if (u < below) return *last;
    }
    if (fields_->rest && sum < 1) return *fields_->rest;
    return last.value_or(fields_->fields[0].type);
}

std::optional<std::set<uint32_t>> GridMixture::possible_types() const
{
    std::set<uint32_t> types;
    for (const auto& field : fields_->fields) types.insert(field.type);
    if (fields_->rest) types.insert(*fields_->rest);
    return types;
}

} // namespace scree
