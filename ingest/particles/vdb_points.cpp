#include "ingest/particles/vdb_points.h"

#include "base/error.h"
#include "base/text.h"
#include "ingest/particles/vdb_point_grid.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointDataGrid.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace scree {

namespace {

namespace points = openvdb::points;
using openvdb::Vec3d;
using Orientation = openvdb::math::Quat<float>;

Imath::V3d from_vdb(const Vec3d& v) { return {v.x(), v.y(), v.z()}; }

template <class T>
std::optional<T> metadata(const openvdb::GridBase& grid, const std::string& name)
{
    const auto value = grid.getMetadata<openvdb::TypedMetadata<T>>(name);
    return value ? std::optional<T>(value->value()) : std::nullopt;
}

void read_metadata(const openvdb::GridBase& grid, ParticleFrame& frame)
{
    frame.step = metadata<int64_t>(grid, "step").value_or(0);
    frame.time = metadata<double>(grid, "time");
    frame.units = metadata<std::string>(grid, "units").value_or("");
    const auto domain_lo = metadata<Vec3d>(grid, "domain_lo"), domain_hi = metadata<Vec3d>(grid, "domain_hi");
    if (domain_lo && domain_hi) frame.domain = Imath::Box3d(from_vdb(*domain_lo), from_vdb(*domain_hi));
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

constexpr auto what_is_needed = "a PointDataGrid with P and pscale";

std::vector<std::string> names_of_points(openvdb::io::File& file)
{
    std::vector<std::string> names;
    for (auto name = file.beginName(); name != file.endName(); ++name)
        if (file.readGridMetadata(name.gridName())->isType<points::PointDataGrid>()) names.push_back(name.gridName());
    return names;
}

std::vector<points::PointDataGrid::Ptr> grids_called(openvdb::io::File& file, const std::string& place,
                                                     const std::string& wanted)
{
    file.open();
    const std::vector<std::string> names = names_of_points(file);
    if (names.empty())
        throw InputError(place, "no grid of points", what_is_needed,
                         "density and distance fields do not hold particles");
    const std::string& first = wanted.empty() ? names[0] : wanted;
    std::vector<points::PointDataGrid::Ptr> grids;
    for (const std::string& name : names) { // with the further batches of VdbPointStream
        if (name != first && !name.starts_with(first + "_part_")) continue;
        grids.push_back(openvdb::gridPtrCast<points::PointDataGrid>(file.readGrid(name)));
    }
    if (grids.empty())
        throw InputError(place, "grids of points " + join_words(names),
                         fmt::format("a PointDataGrid '{}'{}", wanted, did_you_mean(wanted, names)));
    return grids;
}

/// Copies one leaf's points to the end of the frame.
void append_leaf(const points::PointDataTree::LeafNodeType& leaf, const points::PointDataGrid& grid,
                 const std::string& place, ParticleFrame& frame)
{
    const auto& descriptor = leaf.attributeSet().descriptor();
    const auto has = [&](const char* name, const auto& type) {
        return descriptor.find(name) != points::AttributeSet::INVALID_POS &&
               leaf.constAttributeArray(name).valueType() == type;
    };
    if (!has("P", "vec3s"))
        throw InputError(place, "points without P as vec3s", "positions P of 32-bit floats (vec3s)");
    if (!has("pscale", "float"))
        throw InputError(place, "points without float pscale", "the radius of each point as float pscale");
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
            throw InputError(place, fmt::format("a point at ({}, {}, {}) of radius {}", p.x, p.y, p.z, r),
                             "finite positions, and radii of 0 or more");
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

template <class T>
void reorder(std::vector<T>& values, const std::vector<size_t>& order)
{
    if (values.size() != order.size()) return;
    std::vector<T> sorted(values.size());
    for (size_t i = 0; i < order.size(); ++i) sorted[i] = values[order[i]];
    values.swap(sorted);
}

void finish(ParticleFrame& frame, const std::string& place)
{
    if (!frame.orientation.empty() && frame.orientation.size() != frame.size())
        throw InputError(place, "orientations of some points only", "the attribute orient for all points or for none");
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
    frame.origin = frame.domain ? 0.5 * frame.domain->min + 0.5 * frame.domain->max : middle_of_bounds(frame.position);
}

} // namespace

namespace {

/// Runs `work` on the file and turns OpenVDB's exceptions into InputError.
template <class Work>
auto with_file(const std::filesystem::path& path, const Work& work)
{
    openvdb::initialize();
    try {
        openvdb::io::File file(path.string());
        return work(file);
    } catch (const openvdb::Exception& failure) {
        throw InputError(path.string(), failure.what(), "an OpenVDB file of points");
    }
}

ParticleFrame frame_of(const std::vector<points::PointDataGrid::Ptr>& grids, const std::string& place)
{
    ParticleFrame frame;
    for (const auto& grid : grids)
        for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) append_leaf(*leaf, *grid, place, frame);
    read_metadata(*grids[0], frame);
    finish(frame, place);
    return frame;
}

void write_grids(const openvdb::GridCPtrVec& grids, const std::filesystem::path& path)
{
    try {
        openvdb::io::File(path.string()).write(grids);
    } catch (const openvdb::Exception& failure) {
        throw InputError(path.string(), failure.what(), "a file that can be written");
    }
}

} // namespace

void write_vdb_points(const ParticleFrame& frame, const std::filesystem::path& path)
{
    write_grids({make_point_grid(frame, "points", path.string())}, path);
}

void write_vdb_points(std::span<const NamedPoints> grids, const std::filesystem::path& path)
{
    openvdb::GridCPtrVec all;
    for (const NamedPoints& grid : grids) all.push_back(make_point_grid(grid.frame, grid.name, path.string()));
    write_grids(all, path);
}

ParticleFrame read_vdb_points(const std::filesystem::path& path)
{
    const std::string place = path.string();
    return with_file(path, [&](openvdb::io::File& file) { return frame_of(grids_called(file, place, ""), place); });
}

ParticleFrame read_vdb_points(const std::filesystem::path& path, const std::string& name)
{
    const std::string place = path.string();
    return with_file(path, [&](openvdb::io::File& file) { return frame_of(grids_called(file, place, name), place); });
}

std::vector<std::string> list_vdb_points(const std::filesystem::path& path)
{
    return with_file(path, [](openvdb::io::File& file) {
        file.open();
        return names_of_points(file);
    });
}

} // namespace scree
