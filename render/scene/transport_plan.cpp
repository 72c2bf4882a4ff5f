#include "render/scene/transport_plan.h"

#include "base/hash.h"

#include <fmt/format.h>

#include <bit>

namespace scree {

namespace {

/// Fewer grains are all traced as explicit geometry: proxies and a medium would take longer to prepare than they save.
constexpr uint64_t few_grains = 2000;

/// Light that hits fewer grains is traced faster from grain to grain than through a medium.
constexpr double few_encounters = 4;

/// If the largest shell has fewer mean free paths, few paths reach places where it fits, and the tables of the shells
/// cost more than they save.
constexpr double worthwhile_shell = 8;

/// A medium saves work if it has more volume than the grains above it.
constexpr double least_core = 1.5; ///< half the smallest extent of the grains, in depths of the medium

double half_thickness(const GrainFacts& facts)
{
    const V3d extent = facts.bounds.size();
    return facts.bounds.isEmpty() ? 0 : 0.5 * std::min({extent.x, extent.y, extent.z});
}

std::string proxies_after(uint32_t grains)
{
    if (grains == 0) return "proxies replace every grain";
    return grains == 1 ? "proxies replace all grains except the first of a path"
                       : fmt::format("proxies replace all grains except the first {} of a path", grains);
}

/// Upper bound on the width of the largest grain in the picture, in pixels.
double largest_in_pixels(const CameraDescription& camera, const FilmDescription& film, const GrainFacts& facts)
{
    const V3d view = (camera.target - camera.origin).normalized();
    double nearest = std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 8; ++corner) {
        const V3d p((corner & 1 ? facts.bounds.max : facts.bounds.min).x,
                    (corner & 2 ? facts.bounds.max : facts.bounds.min).y,
                    (corner & 4 ? facts.bounds.max : facts.bounds.min).z);
        nearest = std::min(nearest, (p - camera.origin).dot(view));
    }
    const PixelSize pixel = pixel_size(camera, film);
    const double width = pixel.width + pixel.slope * std::max(0.0, nearest);
    return width > 0 ? 2 * facts.largest_radius / width : std::numeric_limits<double>::infinity();
}

} // namespace

PixelSize pixel_size(const CameraDescription& camera, const FilmDescription& film)
{
    if (camera.kind == CameraKind::orthographic) return {camera.width / film.width, 0};
    return {0, 2 * std::tan(0.5 * camera.fov * pi / 180) / std::min(film.width, film.height)};
}

std::string TransportPlan::name() const
{
    return kind == IntegratorKind::automatic && explicit_grains == all_grains && !has_grain_medium && !has_shells
               ? "ept"
               : integrator_names[kind];
}

uint64_t hash_plan(const TransportPlan& plan)
{
    uint64_t hash = 0;
    const auto add = [&hash](uint64_t bits) { hash = mix64(hash ^ bits) + 1; };
    const auto add_number = [&](double number) { add(std::bit_cast<uint64_t>(number)); };
    add(static_cast<uint64_t>(plan.accuracy));
    add(plan.has_proxies());
    if (plan.has_proxies()) {
        add(plan.explicit_grains);
        add_number(plan.least_pixels);
    }
    add(plan.has_grain_medium + 2 * plan.replaces_all);
    if (plan.has_grain_medium) {
        add(static_cast<uint64_t>(plan.medium_form));
        add_number(plan.depth_radii);
        add_number(plan.depth_flights);
    }
    add(plan.has_shells);
    if (plan.has_shells) {
        add(static_cast<uint64_t>(plan.stf_form));
        add_number(plan.least_shell);
        add(plan.shells_must_pay);
    }
    return hash;
}

double rough_loss(const Material& material, double radius)
{
    switch (material.kind) {
    case MaterialKind::lambert: return 1 - max_component(material.reflectance);
    case MaterialKind::dielectric: {
        const Real least = std::min({material.absorption.x, material.absorption.y, material.absorption.z});
        const double within = 4.0 / 3 * 1.3 * radius; // the mean chord of a sphere, lengthened by reflections inside it
        return 1 - max_component(material.tint) * std::exp(-least * within);
    }
    case MaterialKind::conductor: return 1 - 0.9 * max_component(material.tint);
    }
    return 1;
}

TransportPlan plan_transport(const IntegratorDescription& integrator, const CameraDescription& camera,
                             const FilmDescription& film, const GrainFacts& facts)
{
    TransportPlan plan;
    plan.kind = integrator.kind;
    plan.accuracy = integrator.accuracy;
    plan.medium_form = integrator.medium_form;
    plan.stf_form = integrator.stf_form;
    plan.has_grains = facts.count > 0;
    plan.why_no_medium = "the integrator traces grains everywhere";
    switch (integrator.kind) {
    case IntegratorKind::ept: plan.why = "every grain is traced as explicit geometry"; break;
    case IntegratorKind::ppt:
        plan.explicit_grains = integrator.explicit_grains.value_or(0);
        plan.least_pixels = integrator.grain_pixels.value_or(0);
        plan.why = proxies_after(plan.explicit_grains);
        break;
    case IntegratorKind::stf:
    case IntegratorKind::vpt:
        plan.has_grain_medium = plan.replaces_all = plan.has_grains;
        plan.why = "a medium replaces all grains";
        break;
    case IntegratorKind::automatic: {
        const AccuracyLevel& level = level_of(integrator.accuracy);
        plan.depth_radii = level.depth_radii;
        plan.depth_flights = level.depth_flights;
        if (integrator.accuracy == Accuracy::reference)
            plan.why = "every grain is traced as explicit geometry: the accuracy is reference";
        else if (facts.count < few_grains)
            plan.why = fmt::format("every grain is traced as explicit geometry: there are fewer than {}", few_grains);
        else if (facts.encounters() < few_encounters)
            plan.why = fmt::format("every grain is traced as explicit geometry: light hits about {:.2g} grains before "
                                   "it leaves or is absorbed",
                                   facts.encounters());
        else {
            plan.explicit_grains = level.explicit_grains;
            plan.least_pixels = integrator.grain_pixels.value_or(level.least_pixels);
            plan.why = proxies_after(plan.explicit_grains);
            if (const double pixels = largest_in_pixels(camera, film, facts);
                plan.explicit_grains > 0 && pixels < plan.least_pixels) {
                plan.explicit_grains = 0;
                plan.why = fmt::format("{}: the largest looks only {:.2g} pixels wide", proxies_after(0), pixels);
            } else if (plan.explicit_grains == 0) {
                plan.why = proxies_after(0) + ": the accuracy is draft";
            }
            plan.has_grain_medium = half_thickness(facts) > least_core * plan.depth_radii * facts.mean_radius;
            plan.why_no_medium = fmt::format("few grains lie {:g} mean radii deep", plan.depth_radii);
        }
        if (integrator.explicit_grains) { // explicit, however small they look, unless grain_pixels is set too
            plan.explicit_grains = *integrator.explicit_grains;
            plan.least_pixels = integrator.grain_pixels.value_or(0);
            plan.why = proxies_after(plan.explicit_grains) + ", as asked for";
        }
        break;
    }
    }
    if ((integrator.grain_depth || integrator.grain_flights) && !plan.replaces_all && plan.has_grains) {
        if (integrator.grain_depth) plan.depth_flights = 0;
        plan.depth_radii = integrator.grain_depth.value_or(plan.depth_radii);
        plan.depth_flights = integrator.grain_flights.value_or(plan.depth_flights);
        plan.has_grain_medium = half_thickness(facts) > plan.depth_radii * facts.mean_radius;
        plan.why_no_medium = fmt::format("no place is {:g} mean radii deep", plan.depth_radii);
    }
    plan.has_shells = integrator.shells.value_or(
        integrator.kind == IntegratorKind::stf ||
        (integrator.kind == IntegratorKind::automatic && integrator.accuracy != Accuracy::reference));
    if (integrator.kind == IntegratorKind::automatic && !integrator.shells) plan.least_shell = worthwhile_shell;
    plan.shells_must_pay =
        integrator.kind == IntegratorKind::automatic && !integrator.shells && !integrator.least_shell;
    plan.least_shell = integrator.least_shell.value_or(plan.least_shell);
    if (!plan.has_grains) plan.why = plan.why_no_medium = "the scene has no grains";
    if (plan.has_grain_medium) plan.why_no_medium.clear();
    return plan;
}

} // namespace scree
