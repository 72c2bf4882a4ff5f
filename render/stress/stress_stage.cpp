#include "render/stress/stress_stage.h"

#include "base/error.h"
#include "base/json.h"
#include "render/loop/render_setup.h"

#include <cstdlib>

namespace scree {

namespace {

class ScratchFolder {
public:
    ScratchFolder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "scree_stress_XXXXXX").string();
        if (!::mkdtemp(name.data()))
            throw InputError(name, "a folder that cannot be created", "room for temporary files",
                             "set TMPDIR to a folder for them");
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

SceneDescription read_back(const StressScene& scene, const Placing& placing, const StressView& view,
                           const std::filesystem::path& folder)
{
    const std::filesystem::path file = write_stress_scene(scene, placing, folder);
    SceneDescription description = read_scene(JsonDocument::load(file), file);
    description.integrator = scene.description.integrator;
    description.integrator.kind = view.kind;
    description.integrator.accuracy = view.accuracy;
    return description;
}

} // namespace

struct StressStage::Impl {
    ScratchFolder folder;
    WorldBuilder builder;
    BuiltFrame built;
    RenderSetup setup;

    Impl(const StressScene& scene, const Placing& placing, const StressView& view, const Progress& progress)
        : builder(read_back(scene, placing, view, folder.path())), built(builder.build(0, progress)),
          setup(builder, built, RenderJob{})
    {
    }
};

StressStage::StressStage(const StressScene& scene, const Placing& placing, const StressView& view,
                         const Progress& progress)
    : impl_(std::make_unique<Impl>(scene, placing, view, progress))
{
}

StressStage::~StressStage() = default;

const World& StressStage::world() const { return impl_->setup.world(); }
const TransportPlan& StressStage::plan() const { return impl_->built.plan; }

StressPicture StressStage::render(const StressView& view, const Progress& progress) const
{
    const RenderSetup& setup = impl_->setup;
    const SceneDescription& scene = impl_->builder.scene();
    RenderOptions options = setup.options();
    options.spp = view.spp;
    options.seed = view.seed;
    options.timeout = view.timeout;
    options.path.direct_light = view.direct_light;
    const int w = scene.film.width, h = scene.film.height;
    StressPicture picture{Film(w, h, 0, 0, w, h), {}};
    picture.statistics =
        scree::render(setup.world(), setup.tracer(), setup.camera(), setup.filter(), picture.film, options, progress);
    if (progress.cancelled()) throw Cancelled();
    return picture;
}

} // namespace scree
