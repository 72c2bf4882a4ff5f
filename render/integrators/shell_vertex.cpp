// Shell tracing (Müller et al. 2016, algorithm 2): a path goes from the centre of a ball of a medium to its surface in
// one step.

#include "base/warp.h"
#include "render/integrators/path.h"
#include "render/stf/medium_shells.h"

namespace scree {

std::optional<bool> Path::step_through_shell(Hit& met)
{
    const MediumRegion* const region = only_region();
    if (!region || ray_.passed > 0 || (surrounding_ && !is_black(surrounding_->absorption))) return std::nullopt;
    const MediumShells* shells = region->shells.get();
    if (!shells) return std::nullopt;
    const double clear = this->clear();
    FittingShell shell;
    if (!shells->fit(ray_.o, clear, shells->needs_chance() ? sampler_.next() : 0, shell)) return std::nullopt;

    met.place.kind = HitKind::medium;
    met.t = shell.length;
    ++result_.shells;
    if (sampler_.next() < std::exp(-shell.radius)) {
        met.point = ray_.o + shell.length * ray_.d;
        moved_ += shell.length;
        start_ray(met.point, ray_.d, {});
        last_.elsewhere = true;
        return true;
    }
    if (is_cut()) return false;
    if (!result_.first.hit && depth_ == 1) {
        result_.first.hit = true;
        result_.first.albedo = shell.albedo;
        result_.first.depth = moved_ + first_flight(shell);
    }
    if (shells->form() == StfForm::diffusion) return diffuse_through(shell, met);
    const bool is_full = shells->form() == StfForm::full;
    // The fraction of light that reaches the shell from outside the clear ball.
    const double beyond = clear - shell.length, reached = region->medium->uniform()
                                                              ? std::exp(-shell.sigma_t * beyond)
                                                              : light_reaching(beyond, shell.sigma_t);
    const bool lit = samples_lights() && (reached >= 1 || sampler_.next() < reached);
    const double scale = shell.length / shell.radius; // of a mean free path
    if (lit) {
        if (is_full)
            add_event_light(shell, scale, 1 / reached);
        else
            add_single_light(shell, 1 / reached);
    }

    const ShellFrame frame(ray_.d, sampler_.next());
    const ShellExit& exit = shell.shell->exit(sampler_.next());
    const ShellPlace there = place_of(exit);
    const V3d normal = frame.to_world(there.place);
    weight_ *= shell.ratio(exit.events) * shell.shell->survival();
    if (!survives()) return false;
    met.point = ray_.o + shell.length * normal;
    if (is_full || exit.events == 1) {
        const V3d direction = frame.to_world(there.direction).normalized();
        start_ray(met.point, direction, {});
        last_ = {false, shell.phase.pdf(exit.cosine), ray_.o - scale * double{exit.flight} * direction, true};
        return true;
    }
    return leave_by_cosine(met.point, normal, lit ? static_cast<Real>(1 / reached) : 0);
}

bool Path::diffuse_through(const FittingShell& shell, Hit& met)
{
    const double u = sampler_.next(), v = sampler_.next();
    const V3d normal = sample_sphere(u, v);
    const auto left = [&](double albedo) {
        const double g = shell.phase.mean_cosine(), d = 1 / (3 * (1 - albedo * g)), kappa = std::sqrt((1 - albedo) / d),
                     beyond = 2 * d;
        const double x = kappa * (shell.radius + beyond);
        if (x > 300) return 0.0;
        const double flux = kappa * shell.radius * std::cosh(kappa * beyond) + std::sinh(kappa * beyond);
        return x > 1e-8 ? flux / std::sinh(x) : 1.0;
    };
    weight_ *= Weight(left(shell.albedo.x), left(shell.albedo.y), left(shell.albedo.z));
    if (!survives()) return false;
    met.point = ray_.o + shell.length * normal;
    const bool lit = samples_lights();
    return leave_by_cosine(met.point, normal, lit ? 1 : 0);
}

bool Path::leave_by_cosine(const V3d& place, const V3d& normal, Real light_weight)
{
    if (light_weight > 0) {
        const double u0 = sampler_.next(), u1 = sampler_.next(), u2 = sampler_.next();
        const LightSample light = world_.lights.sample(place, u0, u1, u2);
        const double cosine = light.valid ? light.direction.dot(normal) : 0;
        if (cosine > 0) {
            const Color passed = passing(place, light.direction, light.distance, {}, light.light, media_.regions);
            if (!is_black(passed))
                add_light_sample(light, light.distance, Color(light_weight * static_cast<Real>(cosine / pi)),
                                 cosine / pi, passed);
        }
    }
    const double u = sampler_.next(), v = sampler_.next();
    const V3d local = sample_cosine_hemisphere(u, v);
    start_ray(place, Frame(normal).to_world(local).normalized(), {});
    last_ = {false, pdf_cosine_hemisphere(local), place};
    return true;
}

void Path::add_event_light(const FittingShell& shell, double scale, double weight)
{
    const ShellFrame frame(ray_.d, sampler_.next());
    const ShellEvent& event = shell.shell->event(sampler_.next());
    const V3d place = ray_.o + scale * frame.to_world({event.aside, 0, event.along});
    weight *= shell.shell->event_weight() / shell.shell->closeness(event);
    add_phase_light(place, frame.to_world(V3d(event.direction)), shell.phase,
                    Color(shell.ratio(event.events) * weight));
}

double Path::first_flight(const FittingShell& shell)
{
    return -std::log1p(-sampler_.next() * -std::expm1(-shell.radius)) * shell.length / shell.radius;
}

void Path::add_single_light(const FittingShell& shell, double weight)
{
    add_phase_light(ray_.o + first_flight(shell) * ray_.d, ray_.d, shell.phase, shell.albedo * weight);
}

void Path::add_phase_light(const V3d& place, const V3d& before, const PhaseFunction& phase, const Color& weight)
{
    const double u0 = sampler_.next(), u1 = sampler_.next(), u2 = sampler_.next();
    const LightSample light = world_.lights.sample(place, u0, u1, u2);
    if (!light.valid) return;
    const double density = phase.pdf(before.dot(light.direction));
    const Color passed = passing(place, light.direction, light.distance, {}, light.light, media_.regions);
    if (!is_black(passed))
        add_light_sample(light, light.distance, weight * static_cast<Real>(density), density, passed);
}

} // namespace scree
