#include "render/loop/render_setup.h"

#include "render/loop/job_report.h"

#include <algorithm>

namespace scree {

SceneDescription load_scene(const RenderJob& job) { return load_scene(job.scene, job.overrides, job.switches); }

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

RenderSetup::RenderSetup(const WorldBuilder& builder, const BuiltFrame& built, const RenderJob& job)
    : RenderSetup(builder, built, job, builder.device()->bytes(), Stopwatch())
{
}

RenderSetup::RenderSetup(const WorldBuilder& builder, const BuiltFrame& built, const RenderJob& job,
                         int64_t bytes_before, const Stopwatch& watch)
    : world_(built.world), tracer_(builder.device(), *world_), camera_(make_camera(builder.scene(), world_->space)),
      filter_(builder.scene().film.filter), options_(job.options),
      parts_(all_parts(builder.scene(), built, job.crop || job.pixel_bounds))
{
    parts_.push_back({"acceleration structure", true, "Embree", watch.seconds(),
                      static_cast<uint64_t>(std::max<int64_t>(0, builder.device()->bytes() - bytes_before))});
    const SceneDescription& scene = builder.scene();
    const TransportPlan& plan = built.plan;
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
