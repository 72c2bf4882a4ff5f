#include "render/bench/stress/stress_stage.h"

#include "ingest/support/error.h"
#include "ingest/support/json.h"
#include "render/scene/world_builder.h"

#include <cstdlib>

namespace scree {

namespace {

class ScratchFolder {
public:
    ScratchFolder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "scree_stress_XXXXXX").string();
        if (!::mkdtemp(name.data())) throw InputError(name, "a folder that cannot be made", "room for temporary files", "TMPDIR names their folder");
        path_ = name;
    }
    ~ScratchFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

SceneDescription read_back(const StressScene& scene, const Placing& placing, const StressView& view, const std::filesystem::path& folder)
{
    const std::filesystem::path file = write_stress_scene(scene, placing, folder);
    SceneDescription description = read_scene(JsonDocument::load(file), file);
    description.integrator = scene.description.integrator;
    description.integrator.kind = view.kind;
    description.integrator.accuracy = view.accuracy;
    return description;
}

Camera placed_camera(const SceneDescription& scene, const RenderSpace& space)
{
    CameraDescription c = scene.camera;
    c.origin = space.point(c.origin);
    c.target = space.point(c.target);
    c.width = space.length(c.width);
    c.aperture = space.length(c.aperture);
    c.focus = space.length(c.focus);
    return Camera(c, scene.film.width, scene.film.height);
}

} // namespace

struct StressStage::Impl {
    ScratchFolder folder;
    WorldBuilder builder;
    std::shared_ptr<const World> world;
    Tracer tracer;
    Camera camera;

    Impl(const StressScene& scene, const Placing& placing, const StressView& view, const Progress& progress)
        : builder(read_back(scene, placing, view, folder.path())), world(builder.build(0, progress)), tracer(builder.device(), *world),
          camera(placed_camera(builder.scene(), world->space))
    {
    }
};

StressStage::StressStage(const StressScene& scene, const Placing& placing, const StressView& view, const Progress& progress)
    : impl_(std::make_unique<Impl>(scene, placing, view, progress))
{
}

StressStage::~StressStage() = default;

const World& StressStage::world() const { return *impl_->world; }
const TransportPlan& StressStage::plan() const { return impl_->builder.plan(); }

StressPicture StressStage::render(const StressView& view, const Progress& progress) const
{
    const SceneDescription& scene = impl_->builder.scene();
    const TransportPlan& plan = impl_->builder.plan();
    RenderOptions options;
    options.spp = view.spp;
    options.seed = view.seed;
    options.timeout = view.timeout;
    options.path.direct_light = view.direct_light;
    options.path.max_depth = scene.integrator.max_depth;
    if (plan.has_proxies()) options.path.explicit_grains = plan.explicit_grains;
    const PixelSize pixel = pixel_size(scene.camera, scene.film);
    options.path.resolved = {plan.least_pixels * impl_->world->space.length(pixel.width), plan.least_pixels * pixel.slope};
    const int w = scene.film.width, h = scene.film.height;
    StressPicture picture{Film(w, h, 0, 0, w, h), {}};
    picture.statistics = scree::render(*impl_->world, impl_->tracer, impl_->camera, scene.film.filter, picture.film, options, progress);
    if (progress.cancelled()) throw Cancelled();
    return picture;
}

} // namespace scree
