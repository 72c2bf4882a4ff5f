#pragma once

#include "render/loop/render_loop.h"
#include "render/scene/transport_plan.h"
#include "render/stress/stress_scene.h"

#include <memory>
#include <optional>

namespace scree {

/// How a stress scene is rendered.
struct StressView {
    IntegratorKind kind = IntegratorKind::ept;
    Accuracy accuracy = Accuracy::standard;
    uint32_t spp = 16;
    uint64_t seed = 1;
    DirectLight direct_light = DirectLight::both;
    double timeout = 120; ///< seconds after which unfinished paths are given up, which counts as a failure
};

struct StressPicture {
    Film film;
    RenderStatistics statistics;
};

/// A stress scene ready to render: written to a temporary folder, read by the code that reads user scenes, and built.
class StressStage {
public:
    /// Uses only the integrator and accuracy of the view. Throws InputError, Cancelled.
    StressStage(const StressScene& scene, const Placing& placing, const StressView& view, const Progress& progress);
    ~StressStage();

    /// Throws Cancelled.
    StressPicture render(const StressView& view, const Progress& progress) const;
    const World& world() const;
    const TransportPlan& plan() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
