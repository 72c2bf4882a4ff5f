#include "render/media/vdb_medium.h"

#include "base/error.h"
#include "base/text.h"
#include "render/media/grid_medium_build.h"

#include <fmt/format.h>

namespace scree {

namespace {

/// Runs `work` on the opened file; turns OpenVDB's exceptions into InputError.
template <class Work>
auto with_file(const std::filesystem::path& path, const Work& work)
{
    openvdb::initialize();
    try {
        openvdb::io::File file(path.string());
        file.open();
        return work(file);
    } catch (const openvdb::Exception& failure) {
        throw InputError(path.string(), failure.what(), "an OpenVDB file with a grid of densities");
    }
}

void require(openvdb::io::File& file, const std::string& name, const std::string& key)
{
    if (file.hasGrid(name)) return;
    std::vector<std::string> names, described;
    for (auto it = file.beginName(); it != file.endName(); ++it) {
        names.push_back(it.gridName());
        described.push_back(fmt::format("'{}' ({})", it.gridName(), file.readGridMetadata(it.gridName())->valueType()));
    }
    throw InputError(file.filename(),
                     names.empty() ? "no grid at all"
                                   : fmt::format("no grid '{}', but {}", name, join_words(described)),
                     fmt::format("the grid '{}' for \"{}\"", name, key),
                     names.empty() ? "" : fmt::format("set \"{}\" to a grid's name{}", key, did_you_mean(name, names)));
}

openvdb::GridBase::Ptr read(openvdb::io::File& file, const std::string& name, const std::string& key)
{
    require(file, name, key);
    return file.readGrid(name);
}

} // namespace

GridMedium read_vdb_medium(const std::filesystem::path& file, const VdbMediumOptions& options, const RenderSpace& space,
                           const Progress& progress)
{
    return with_file(file, [&](openvdb::io::File& opened) {
        MediumGrids grids;
        grids.place = file.string();
        grids.to_scene = options.to_scene;
        grids.density = read(opened, options.density, "density");
        if (!options.albedo.empty()) grids.albedo = read(opened, options.albedo, "albedo");
        if (!options.g.empty()) grids.g = read(opened, options.g, "g");
        return make_grid_medium(grids, options.medium, space, progress);
    });
}

Imath::Box3d vdb_medium_bounds(const std::filesystem::path& file, const VdbMediumOptions& options)
{
    return with_file(file, [&](openvdb::io::File& opened) {
        require(opened, options.density, "density");
        openvdb::GridBase::ConstPtr grid = opened.readGridMetadata(options.density);
        const auto lo = grid->getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MIN);
        const auto hi = grid->getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MAX);
        openvdb::CoordBBox voxels;
        if (lo && hi) {
            voxels = openvdb::CoordBBox(openvdb::Coord(lo->value()), openvdb::Coord(hi->value()));
        } else {
            grid = opened.readGrid(options.density);
            voxels = grid->evalActiveVoxelBoundingBox();
        }
        Imath::Box3d bounds;
        if (voxels.empty()) return bounds;
        for (int corner = 0; corner < 8; ++corner) {
            // Interpolation reaches one voxel beyond the active ones.
            openvdb::Vec3d voxel;
            for (int k = 0; k < 3; ++k) voxel[k] = corner >> k & 1 ? voxels.max()[k] + 1 : voxels.min()[k] - 1;
            const openvdb::Vec3d p = grid->transform().indexToWorld(voxel);
            V3d place;
            options.to_scene.multVecMatrix(V3d(p.x(), p.y(), p.z()), place);
            bounds.extendBy(place);
        }
        return bounds;
    });
}

} // namespace scree
