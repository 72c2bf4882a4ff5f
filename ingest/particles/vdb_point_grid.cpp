#include "ingest/particles/vdb_point_grid.h"

#include "base/error.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/PointIndexGrid.h>

#include <algorithm>
#include <limits>

namespace scree {

namespace {

namespace points = openvdb::points;
using openvdb::Vec3d;
using Orientation = openvdb::math::Quat<float>;

Vec3d to_vdb(const Imath::V3d& v) { return {v.x, v.y, v.z}; }

/// Four mean radii.
double default_voxel(const ParticleFrame& frame)
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
    // Voxel coordinates have 32 bits, so a grain far out needs larger voxels.
    const double least = reach / double(1 << 29);
    const double size = std::max(from_radius > 0 ? from_radius : from_extent, least);
    return size > 0 ? size : 1;
}

template <class T>
void add_attribute(points::PointDataGrid& grid, const openvdb::tools::PointIndexGrid& index, const char* name,
                   const std::vector<T>& values)
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
    if (frame.domain) {
        grid.insertMeta("domain_lo", openvdb::Vec3DMetadata(to_vdb(frame.domain->min)));
        grid.insertMeta("domain_hi", openvdb::Vec3DMetadata(to_vdb(frame.domain->max)));
    }
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

} // namespace

points::PointDataGrid::Ptr make_point_grid(const ParticleFrame& frame, const std::string& name,
                                           const std::string& place, double voxel)
{
    openvdb::initialize();
    for (const uint64_t id : frame.id)
        if (id > static_cast<uint64_t>(std::numeric_limits<int64_t>::max()))
            throw InputError(place, fmt::format("id {}", id), "ids below 2^63, which fit int64");
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel > 0 ? voxel : default_voxel(frame));
    transform->postTranslate(to_vdb(frame.origin));
    std::vector<Vec3d> positions(frame.size());
    std::ranges::transform(frame.position, positions.begin(), to_vdb);
    std::vector<int64_t> ids(frame.id.begin(), frame.id.end());
    std::vector<Orientation> orientations;
    for (const Imath::Quatf& q : frame.orientation) orientations.emplace_back(q.v.x, q.v.y, q.v.z, q.r);

    const points::PointAttributeVector<Vec3d> places(positions);
    const auto index = openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(places, *transform);
    auto grid = points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(*index, places, *transform);
    grid->setName(name);
    add_attribute(*grid, *index, "pscale", frame.radius);
    add_attribute(*grid, *index, "type", frame.type);
    if (frame.has_ids) add_attribute(*grid, *index, "id", ids);
    if (!orientations.empty()) add_attribute(*grid, *index, "orient", orientations);
    // An attribute that is the same for all points of a leaf, often radius and type, is then stored once.
    points::compactAttributes(grid->tree());
    add_metadata(*grid, frame);
    return grid;
}

} // namespace scree
