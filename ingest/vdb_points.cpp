#include "ingest/vdb_points.h"

#include "ingest/support/error.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/PointIndexGrid.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace scree {

namespace {

namespace points = openvdb::points;
using openvdb::Vec3d;
using Orientation = openvdb::math::Quat<float>;

Vec3d to_vdb(const Imath::V3d& v) { return {v.x, v.y, v.z}; }
Imath::V3d from_vdb(const Vec3d& v) { return {v.x(), v.y(), v.z()}; }

double voxel_size(const ParticleFrame& frame)
{
    if (frame.size() == 0) return 1;
    double sum = 0, reach = 0;
    for (size_t i = 0; i < frame.size(); ++i) {
        sum += frame.radius[i];
        const Imath::V3d d = frame.position[i] - frame.origin;
        reach = std::max({reach, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    }
    const double from_radius = 4 * sum / double(frame.size());
    const double from_extent = 2 * reach / std::cbrt(double(frame.size()));
    // Voxels are counted in 32 bits, so that a grain far out forces larger ones.
    const double least = reach / double(1 << 29);
    const double size = std::max(from_radius > 0 ? from_radius : from_extent, least);
    return size > 0 ? size : 1;
}

template <class T>
void add_attribute(points::PointDataGrid& grid, const openvdb::tools::PointIndexGrid& index, const char* name, const std::vector<T>& values)
{
    points::appendAttribute(grid.tree(), name, points::TypedAttributeArray<T>::attributeType());
    const points::PointAttributeVector<T> wrapped(values);
    points::populateAttribute(grid.tree(), index.tree(), name, wrapped);
}

void add_metadata(points::PointDataGrid& grid, const ParticleFrame& frame)
{
    grid.insertMeta("step", openvdb::Int64Metadata(frame.step));
    if (frame.time) grid.insertMeta("time", openvdb::DoubleMetadata(*frame.time));
    if (!frame.units.empty()) grid.insertMeta("units", openvdb::StringMetadata(frame.units));
    if (!frame.box) return;
    const SimulationBox& box = *frame.box;
    grid.insertMeta("box_lo", openvdb::Vec3DMetadata(to_vdb(box.lo)));
    std::string periodic;
    for (size_t k = 0; k < 3; ++k) {
        grid.insertMeta(fmt::format("box_edge_{}", k), openvdb::Vec3DMetadata(to_vdb(box.edges[k])));
        periodic += box.periodic[k] ? 'p' : 'f';
    }
    grid.insertMeta("box_periodic", openvdb::StringMetadata(periodic));
    grid.insertMeta("box_triclinic", openvdb::BoolMetadata(box.triclinic));
}

points::PointDataGrid::Ptr make_grid(const ParticleFrame& frame)
{
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel_size(frame));
    transform->postTranslate(to_vdb(frame.origin));
    std::vector<Vec3d> positions(frame.size());
    std::ranges::transform(frame.position, positions.begin(), to_vdb);
    std::vector<int64_t> ids(frame.id.begin(), frame.id.end());
    std::vector<Orientation> orientations;
    for (const Imath::Quatf& q : frame.orientation) orientations.emplace_back(q.v.x, q.v.y, q.v.z, q.r);

    const points::PointAttributeVector<Vec3d> places(positions);
    const auto index = openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(places, *transform);
    auto grid = points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(*index, places, *transform);
    grid->setName("points");
    add_attribute(*grid, *index, "pscale", frame.radius);
    add_attribute(*grid, *index, "type", frame.type);
    if (frame.has_ids) add_attribute(*grid, *index, "id", ids);
    if (!orientations.empty()) add_attribute(*grid, *index, "orient", orientations);
    add_metadata(*grid, frame);
    return grid;
}

template <class T> std::optional<T> metadata(const openvdb::GridBase& grid, const std::string& name)
{
    const auto value = grid.getMetadata<openvdb::TypedMetadata<T>>(name);
    return value ? std::optional<T>(value->value()) : std::nullopt;
}

void read_metadata(const openvdb::GridBase& grid, ParticleFrame& frame)
{
    frame.step = metadata<int64_t>(grid, "step").value_or(0);
    frame.time = metadata<double>(grid, "time");
    frame.units = metadata<std::string>(grid, "units").value_or("");
    const auto lo = metadata<Vec3d>(grid, "box_lo");
    if (!lo) return;
    SimulationBox box;
    box.lo = from_vdb(*lo);
    const std::string periodic = metadata<std::string>(grid, "box_periodic").value_or("");
    for (size_t k = 0; k < 3; ++k) {
        box.edges[k] = from_vdb(metadata<Vec3d>(grid, fmt::format("box_edge_{}", k)).value_or(Vec3d(0)));
        box.periodic[k] = k < periodic.size() && periodic[k] == 'p';
    }
    box.triclinic = metadata<bool>(grid, "box_triclinic").value_or(false);
    frame.box = box;
}

points::PointDataGrid::Ptr find_points(openvdb::io::File& file, const std::string& place)
{
    file.open();
    for (auto name = file.beginName(); name != file.endName(); ++name) {
        const auto grid = openvdb::gridPtrCast<points::PointDataGrid>(file.readGrid(name.gridName()));
        if (grid) return grid;
    }
    throw InputError(place, "no grid of points", "a PointDataGrid with P and pscale", "density and distance fields are no particles");
}

/// Copies one leaf's points to the end of the frame.
void append_leaf(const points::PointDataTree::LeafNodeType& leaf, const points::PointDataGrid& grid, const std::string& place, ParticleFrame& frame)
{
    const auto& descriptor = leaf.attributeSet().descriptor();
    const auto has = [&](const char* name, const auto& type) { return descriptor.find(name) != points::AttributeSet::INVALID_POS && leaf.constAttributeArray(name).valueType() == type; };
    if (!has("P", "vec3s")) throw InputError(place, "points without P as vec3s", "places of 32-bit floats");
    if (!has("pscale", "float")) throw InputError(place, "points without float pscale", "the radius of each point as float pscale");
    const points::AttributeHandle<openvdb::Vec3f> position(leaf.constAttributeArray("P"));
    const points::AttributeHandle<float> radius(leaf.constAttributeArray("pscale"));
    std::optional<points::AttributeHandle<int32_t>> type;
    std::optional<points::AttributeHandle<int64_t>> id;
    std::optional<points::AttributeHandle<Orientation>> orientation;
    if (has("type", "int32")) type.emplace(leaf.constAttributeArray("type"));
    if (has("id", "int64")) id.emplace(leaf.constAttributeArray("id"));
    if (has("orient", "quats")) orientation.emplace(leaf.constAttributeArray("orient"));

    for (auto i = leaf.beginIndexAll(); i; ++i) {
        const Vec3d voxel = i.getCoord().asVec3d() + Vec3d(position.get(*i));
        const Imath::V3d p = from_vdb(grid.transform().indexToWorld(voxel));
        const float r = radius.get(*i);
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z) || !(r >= 0) || !std::isfinite(r))
            throw InputError(place, fmt::format("a point at ({}, {}, {}) of radius {}", p.x, p.y, p.z, r), "finite places, and radii of 0 or more");
        frame.position.push_back(p);
        frame.radius.push_back(r);
        frame.type.push_back(type ? type->get(*i) : 1);
        frame.id.push_back(id ? static_cast<uint64_t>(id->get(*i)) : frame.id.size());
        frame.has_ids = id.has_value();
        if (!orientation) continue;
        const Orientation q = orientation->get(*i);
        frame.orientation.push_back(Imath::Quatf(q.w(), q.x(), q.y(), q.z()));
    }
}

template <class T> void reorder(std::vector<T>& values, const std::vector<size_t>& order)
{
    if (values.size() != order.size()) return;
    std::vector<T> sorted(values.size());
    for (size_t i = 0; i < order.size(); ++i) sorted[i] = values[order[i]];
    values.swap(sorted);
}

void finish(ParticleFrame& frame, const std::string& place)
{
    if (!frame.orientation.empty() && frame.orientation.size() != frame.size())
        throw InputError(place, "orientations of some points only", "orient for all points or none");
    std::vector<size_t> order(frame.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::ranges::stable_sort(order, {}, [&](size_t i) { return frame.id[i]; });
    reorder(frame.position, order);
    reorder(frame.radius, order);
    reorder(frame.type, order);
    reorder(frame.orientation, order);
    reorder(frame.id, order);
    const auto twice = std::ranges::adjacent_find(frame.id);
    if (twice != frame.id.end()) throw InputError(place, fmt::format("id {} twice", *twice), "every id once");
    frame.origin = middle_of_bounds(frame.position);
}

} // namespace

void write_vdb_points(const ParticleFrame& frame, const std::filesystem::path& path)
{
    openvdb::initialize();
    for (const uint64_t id : frame.id)
        if (id > static_cast<uint64_t>(std::numeric_limits<int64_t>::max()))
            throw InputError(path.string(), fmt::format("id {}", id), "ids below 2^63 to write as int64");
    try {
        openvdb::io::File(path.string()).write(openvdb::GridCPtrVec{make_grid(frame)});
    } catch (const openvdb::Exception& failure) {
        throw InputError(path.string(), failure.what(), "a file that can be written");
    }
}

ParticleFrame read_vdb_points(const std::filesystem::path& path)
{
    openvdb::initialize();
    const std::string place = path.string();
    try {
        openvdb::io::File file(place);
        const points::PointDataGrid::Ptr grid = find_points(file, place);
        ParticleFrame frame;
        for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) append_leaf(*leaf, *grid, place, frame);
        read_metadata(*grid, frame);
        finish(frame, place);
        return frame;
    } catch (const openvdb::Exception& failure) {
        throw InputError(place, failure.what(), "an OpenVDB file of points");
    }
}

} // namespace scree
