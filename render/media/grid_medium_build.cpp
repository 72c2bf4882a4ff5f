#include "render/media/grid_medium_build.h"

#include "base/error.h"
#include "render/media/placed_field_build.h"

#include <fmt/format.h>

namespace scree {

namespace {

void check_options(const GridMediumOptions& options, const std::string& place)
{
    for (int c = 0; c < 3; ++c) {
        if (!(options.scale[c] >= 0) || !std::isfinite(options.scale[c]))
            throw InputError(place, fmt::format("a scale of {}", options.scale[c]), "a finite scale of 0 or more");
        if (!(options.albedo[c] >= 0 && options.albedo[c] <= 1))
            throw InputError(place, fmt::format("an albedo of {:g}", options.albedo[c]), "an albedo in 0..1");
    }
    if (!(std::abs(options.g) < 1))
        throw InputError(place, fmt::format("a g of {}", options.g), "an asymmetry g between -1 and 1");
}

} // namespace

GridMedium make_grid_medium(const MediumGrids& grids, const GridMediumOptions& options, const RenderSpace& space,
                            const Progress& progress)
{
    check_options(options, grids.place);
    if (grids.density->getGridClass() == openvdb::GRID_LEVEL_SET)
        throw InputError(grids.place, "a level set as density",
                         "a fog volume: densities of 0 or more inside, 0 outside",
                         "openvdb::tools::sdfToFogVolume, or 'Convert VDB' to fog in Houdini, makes one");
    auto data = std::make_shared<GridMediumData>();
    data->options = options;
    for (int c = 0; c < 3; ++c) data->scale[static_cast<size_t>(c)] = space.world_length(double{options.scale[c]});
    const auto placed = [&](const openvdb::GridBase& grid, const FieldLimits& limits, const auto& may_be_outside,
                            const std::string& outside) {
        PlacedField field =
            make_placed_field(grid, limits, options.nearest, grids.to_scene, space, grids.place, progress);
        for (size_t plane = 0; plane < static_cast<size_t>(field.field.planes); ++plane)
            if (!may_be_outside(double{field.field.background[plane]}))
                throw InputError(grids.place,
                                 fmt::format("{} of {} as background", limits.name, field.field.background[plane]),
                                 outside);
        return field;
    };
    data->density = placed(
        *grids.density,
        {.name = "density",
         .expected = "finite densities of 0 or more",
         .low = 0,
         .high = std::numeric_limits<double>::infinity(),
         .vectors = true},
        [](double density) { return density == 0; }, "a background of 0: a medium cannot fill all of space");
    if (grids.albedo)
        data->albedo = placed(
            *grids.albedo,
            {.name = "albedo",
             .expected = "albedos in 0..1",
             .low = 0,
             .high = 1,
             .vectors = true,
             .mean_beside = true},
            [](double albedo) { return albedo >= 0 && albedo <= 1; }, "albedos in 0..1");
    data->has_albedo = grids.albedo != nullptr;
    if (grids.g)
        data->g = placed(
            *grids.g,
            {.name = "g",
             .expected = "asymmetries between -1 and 1",
             .low = -1,
             .high = 1,
             .open = true,
             .mean_beside = true},
            [](double g) { return std::abs(g) < 1; }, "asymmetries between -1 and 1");
    data->has_g = grids.g != nullptr;
    data->prepare();
    return GridMedium(std::move(data));
}

} // namespace scree
