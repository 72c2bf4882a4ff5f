#include "render/loop/render_setup.h"

#include "base/json.h"
#include "render/loop/job_report.h"

#include <algorithm>

namespace scree {

SceneDescription load_scene(const RenderJob& job)
{
    JsonDocument document = JsonDocument::load(job.scene);
    for (const auto& [path, value] : job.overrides) document.override_value(path, value);
    SceneDescription scene = read_scene(document, job.scene);
    if (job.size) std::tie(scene.film.width, scene.film.height) = *job.size;
    for (const Aov aov : job.aov) {
        if (std::find(scene.film.aov.begin(), scene.film.aov.end(), aov) == scene.film.aov.end())
            scene.film.aov.push_back(aov);
    }
    IntegratorDescription& integrator = scene.integrator;
    if (job.max_depth > 0) integrator.max_depth = job.max_depth;
    integrator.kind = job.integrator.value_or(integrator.kind);
    integrator.accuracy = job.accuracy.value_or(integrator.accuracy);
    if (job.explicit_grains) integrator.explicit_grains = job.explicit_grains;
    if (job.grain_depth) integrator.grain_depth = job.grain_depth;
    integrator.medium_form = job.medium_form.value_or(integrator.medium_form);
    integrator.stf_form = job.stf_form.value_or(integrator.stf_form);
    if (job.grain_pixels) integrator.grain_pixels = job.grain_pixels;
    if (job.grain_flights) integrator.grain_flights = job.grain_flights;
    if (job.least_shell) integrator.least_shell = job.least_shell;
    if (job.shells) integrator.shells = job.shells;
    return scene;
}

Camera make_camera(const SceneDescription& scene, const RenderSpace& space)
{
    CameraDescription c = scene.camera;
    c.origin = space.point(c.origin);
    c.target = space.point(c.target);
    c.width = space.length(c.width);
    c.aperture = space.length(c.aperture);
    c.focus = space.length(c.focus);
    return Camera(c, scene.film.width, scene.film.height);
}

RenderSetup::RenderSetup(const WorldBuilder& builder, std::shared_ptr<const World> world, const RenderJob& job)
    : RenderSetup(builder, std::move(world), job, builder.device()->bytes(), Stopwatch())
{
}

RenderSetup::RenderSetup(const WorldBuilder& builder, std::shared_ptr<const World> world, const RenderJob& job,
                         int64_t bytes_before, const Stopwatch& watch)
    : world_(std::move(world)), tracer_(builder.device(), *world_),
      camera_(make_camera(builder.scene(), world_->space)), filter_(builder.scene().film.filter), options_(job.options),
      parts_(all_parts(builder, *world_, job.crop || job.pixel_bounds))
{
    parts_.push_back({"acceleration structure", true, "Embree", watch.seconds(),
                      static_cast<uint64_t>(std::max<int64_t>(0, builder.device()->bytes() - bytes_before))});
    const SceneDescription& scene = builder.scene();
    const TransportPlan& plan = builder.plan();
    options_.path.max_depth = scene.integrator.max_depth;
    if (plan.has_proxies()) options_.path.explicit_grains = plan.explicit_grains;
    const PixelSize pixel = pixel_size(scene.camera, scene.film);
    options_.path.resolved = {plan.least_pixels * world_->space.length(pixel.width), plan.least_pixels * pixel.slope};
    if (job.spp)
        options_.spp = *job.spp;
    else if (options_.timeout > 0 || options_.error > 0)
        options_.spp = 1u << 30;
}

} // namespace scree
