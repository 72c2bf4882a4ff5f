// Scenes that are scaled, moved and turned as a whole: their pictures must not change.

#include "render/stress/stress_furnace.h"
#include "render/stress/stress_scenes.h"

#include <fmt/format.h>

namespace scree {

namespace {

/// Samples a pixel where means are compared: fewer where a medium replaces grains, because that takes longer.
uint32_t mean_spp(IntegratorKind kind)
{
    return kind == IntegratorKind::ept || kind == IntegratorKind::ppt ? 1024 : 384;
}

/// A scene and its name.
struct NamedScene {
    std::string name;
    StressScene scene;
};

StressScene lit(StressScene scene)
{
    add_day(scene);
    return scene;
}

/// The scene on which an integrator is tested: the integrator must have something to do there.
NamedScene scene_for(IntegratorKind kind, const Progress& progress)
{
    if (kind == IntegratorKind::ept || kind == IntegratorKind::ppt) return {"48 mixed grains", mixed_scene(progress)};
    return {"2,400 grains", lit(bed_scene({glass_material(1.5, 0, Color(0x1p-8f, 0x1p-7f, 0x1p-5f)),
                                           lambert_material(Color(0.96875f, 0.875f, 0.5f))},
                                          progress))};
}

NamedScene ball() { return {"a ball of medium", ball_of_medium(16, Weight(0.99, 0.9, 0.5), 0.75)}; }

NamedScene filled_cube(const Progress& progress)
{
    return {"a filled cube", lit(filled_scene(lambert_material(Color(0.875f, 0.75f, 0.5f)), 0.125, progress))};
}

StressFinding same_bits(const StressScene& scene, const std::vector<Placing>& placings, const StressView& view,
                        const Progress& progress)
{
    const StressPicture reference = StressStage(scene, {}, view, progress).render(view, progress);
    StressFinding worst;
    worst.count(reference.statistics);
    for (const Placing& placing : placings) {
        const StressPicture picture = StressStage(scene, placing, view, progress).render(view, progress);
        const StressFinding found = compare_bits(picture.film, reference.film);
        if (found.deviation >= worst.deviation) {
            worst.deviation = found.deviation;
            worst.remark = found.remark;
            worst.unit = found.unit;
        }
        worst.count(picture.statistics);
    }
    return worst;
}

/// Compares the placed scene with the original, with different random numbers; and the original with itself, to show
/// the result of the test without a difference.
StressFinding same_in_the_mean(const StressScene& scene, const Placing& placing, StressView view, double bias,
                               const Progress& progress)
{
    const StressStage stage(scene, {}, view, progress);
    const StressPicture first = stage.render(view, progress);
    view.seed = 2;
    const StressPicture control = stage.render(view, progress);
    view.seed = 3;
    const StressPicture placed = StressStage(scene, placing, view, progress).render(view, progress);
    StressFinding finding = compare_means(placed.film, first.film, 6, bias);
    const StressFinding none = compare_means(control.film, first.film, 6);
    finding.remark += fmt::format("; the scene with itself {:.2g} sigma", none.deviation);
    for (const StressPicture* picture : {&first, &control, &placed}) finding.count(picture->statistics);
    return finding;
}

Placing scaled(int exponent)
{
    Placing placing;
    placing.scale = std::ldexp(1.0, exponent);
    return placing;
}

Placing moved(const V3d& offset)
{
    Placing placing;
    placing.offset = offset;
    return placing;
}

Placing turned()
{
    Placing placing;
    const double half = 0.55;
    placing.rotation = Imath::Quatd(std::cos(half), V3d(1, 2, 3).normalized() * std::sin(half));
    return placing;
}

StressExtent extent_of(IntegratorKind kind)
{
    return kind == IntegratorKind::ept ? StressExtent::quick : StressExtent::full;
}

} // namespace

void add_scale_cases(StressRun& run)
{
    run.begin("scale", "the scene scaled by 2^-40 and 2^40, compared with the original, bit by bit",
              "nothing: render coordinates are the same numbers");
    const std::vector<Placing> placings{scaled(-40), scaled(40)};
    const auto add = [&](const NamedScene& named, IntegratorKind kind, StressExtent extent) {
        run.add(fmt::format("{}, {}", named.name, name_of(kind)), extent, [&] {
            return same_bits(named.scene, placings, {.kind = kind, .accuracy = Accuracy::draft, .spp = 8},
                             run.progress());
        });
    };
    for (const IntegratorKind kind : all_kinds) add(scene_for(kind, run.progress()), kind, extent_of(kind));
    for (const IntegratorKind kind : {IntegratorKind::vpt, IntegratorKind::stf})
        add(ball(), kind, kind == IntegratorKind::vpt ? StressExtent::quick : StressExtent::full);
    add(filled_cube(run.progress()), IntegratorKind::ept, StressExtent::full);
}

void add_place_cases(StressRun& run)
{
    run.begin("place, exact",
              "the scene moved by about 1e7 with exact coordinates, compared with the original, bit by bit",
              "nothing: double holds the coordinates, and the scene is centred before they become float");
    const V3d exact(1e7, -1e7, 2e7), inexact(1e7 + 1 / 3.0, -1e7 - 0.1, 2e7 + 0.7);
    const auto add = [&](const NamedScene& named, IntegratorKind kind) {
        run.add(fmt::format("{}, {}", named.name, name_of(kind)), extent_of(kind), [&] {
            return same_bits(named.scene, {moved(exact)}, {.kind = kind, .accuracy = Accuracy::draft, .spp = 8},
                             run.progress());
        });
    };
    for (const IntegratorKind kind : all_kinds) add(scene_for(kind, run.progress()), kind);
    for (const IntegratorKind kind : {IntegratorKind::vpt, IntegratorKind::stf}) add(ball(), kind);
    for (const IntegratorKind kind : {IntegratorKind::ept, IntegratorKind::ppt}) add(filled_cube(run.progress()), kind);
    run.begin("place", "the scene moved by 1e7 of its units, compared with the original in the mean",
              "noise: coordinates near 1e7 keep 2^-29 of a unit in a dump and a scene");
    for (const IntegratorKind kind : all_kinds) {
        const NamedScene named = scene_for(kind, run.progress());
        run.add(fmt::format("{}, {}", named.name, name_of(kind)), extent_of(kind), [&] {
            return same_in_the_mean(named.scene, moved(inexact),
                                    {.kind = kind, .accuracy = Accuracy::draft, .spp = mean_spp(kind)}, 0,
                                    run.progress());
        });
    }
    run.add("a ball of medium, vpt", StressExtent::full, [&] {
        return same_in_the_mean(ball().scene, moved(inexact),
                                {.kind = IntegratorKind::vpt, .spp = mean_spp(IntegratorKind::vpt)}, 0, run.progress());
    });
    for (const IntegratorKind kind : {IntegratorKind::ept, IntegratorKind::ppt}) {
        run.add("a filled cube, " + name_of(kind), StressExtent::full, [&] {
            return same_in_the_mean(filled_cube(run.progress()).scene, moved(inexact),
                                    {.kind = kind, .accuracy = Accuracy::draft, .spp = mean_spp(kind)}, 0,
                                    run.progress());
        });
    }
}

void add_turn_cases(StressRun& run)
{
    run.begin("turn", "the scene turned with its camera, grains and lights, compared with the original in the mean",
              "noise; where a medium replaces grains also 0.5 %, because its hull is found on a grid");
    for (const IntegratorKind kind : all_kinds) {
        const NamedScene named = scene_for(kind, run.progress());
        const bool has_hull = kind != IntegratorKind::ept && kind != IntegratorKind::ppt;
        run.add(fmt::format("{}, {}", named.name, name_of(kind)), extent_of(kind), [&] {
            return same_in_the_mean(named.scene, turned(),
                                    {.kind = kind, .accuracy = Accuracy::draft, .spp = mean_spp(kind)},
                                    has_hull ? 0.005 : 0, run.progress());
        });
    }
    for (const IntegratorKind kind : {IntegratorKind::vpt, IntegratorKind::stf}) {
        run.add("a ball of medium, " + name_of(kind), StressExtent::full, [&] {
            return same_in_the_mean(ball().scene, turned(),
                                    {.kind = kind, .accuracy = Accuracy::draft, .spp = mean_spp(kind)}, 0,
                                    run.progress());
        });
    }
}

} // namespace scree
