#include "render/lights/light.h"

#include "base/warp.h"

#include <limits>

namespace scree {

namespace {

/// Roughly the light's flux into a scene of this radius; lights are chosen in proportion to it.
double rough_power(const Light& light, double scene_radius)
{
    const double disc = pi * scene_radius * scene_radius;
    switch (light.kind) {
    case LightKind::constant: return 0;
    case LightKind::environment: return 4 * pi * disc * luminance(light.map->mean());
    case LightKind::distant: {
        const double h = light.one_minus_cos;
        return disc * luminance(light.radiance) * (h > 0 ? pi * h * (2 - h) : 1);
    }
    case LightKind::rectangle: return 2 * pi * light.area * luminance(light.radiance);
    case LightKind::sphere: return pi * light.area * luminance(light.radiance);
    }
    return 0;
}

/// 1 - cos of the cone that a sphere light fills, seen from a point outside; accurate for small cones too.
double sphere_cone(const Light& light, double distance2)
{
    const double sin2 = light.radius * light.radius / distance2;
    return sin2 / (1 + safe_sqrt(1 - sin2));
}

} // namespace

LightSet::LightSet(std::vector<Light> lights, double scene_radius) : lights_(std::move(lights))
{
    double total = 0;
    for (const Light& light : lights_) {
        choice_.push_back(light.is_sampled() ? rough_power(light, scene_radius) : 0);
        total += choice_.back();
    }
    any_sampled_ = total > 0;
    cumulated_.push_back(0);
    for (double& p : choice_) {
        p = any_sampled_ ? p / total : 0;
        cumulated_.push_back(cumulated_.back() + p);
    }
}

LightSample LightSet::sample(const V3d& point, double u_choice, double u1, double u2) const
{
    const double u = u_choice * cumulated_.back();
    size_t index = 0;
    while (index + 1 < lights_.size() && (cumulated_[index + 1] <= u)) ++index;
    const Light& light = lights_[index];

    LightSample s;
    s.light = static_cast<uint32_t>(index);
    s.distance = std::numeric_limits<double>::infinity();
    s.radiance = light.radiance;
    switch (light.kind) {
    case LightKind::constant: return s;
    case LightKind::environment:
        s.direction = light.map->sample(u1, u2);
        s.radiance = light.map->radiance(s.direction);
        s.pdf = light.map->pdf(s.direction);
        break;
    case LightKind::distant:
        if (light.one_minus_cos == 0) {
            s.direction = light.direction;
            s.delta = true;
            s.pdf = 1;
        } else {
            s.direction = Frame(light.direction).to_world(sample_cone(u1, u2, light.one_minus_cos));
            s.pdf = pdf_cone(light.one_minus_cos);
        }
        break;
    case LightKind::rectangle: {
        const V3d to = light.corner + u1 * light.edge1 + u2 * light.edge2 - point;
        const double distance2 = to.length2();
        s.distance = std::sqrt(distance2);
        s.direction = to / s.distance;
        s.pdf = distance2 / (light.area * std::abs(light.normal.dot(s.direction)));
        break;
    }
    case LightKind::sphere: {
        const V3d to = light.center - point;
        const double distance2 = to.length2(), r2 = light.radius * light.radius;
        if (distance2 <= r2) return s;
        const V3d w = sample_cone(u1, u2, sphere_cone(light, distance2));
        s.direction = Frame(to / std::sqrt(distance2)).to_world(w);
        const double along = to.dot(s.direction);
        s.distance = along - safe_sqrt(r2 - (to - along * s.direction).length2());
        s.pdf = pdf_cone(sphere_cone(light, distance2));
        break;
    }
    }
    s.pdf *= choice_[index];
    s.valid = s.pdf > 0 && std::isfinite(s.pdf);
    return s;
}

double LightSet::pdf(uint32_t index, const V3d& point, const V3d& direction, double distance) const
{
    const Light& light = lights_[index];
    const double choice = choice_[index];
    switch (light.kind) {
    case LightKind::constant: return 0;
    case LightKind::environment: return choice * light.map->pdf(direction);
    case LightKind::distant:
        if (light.one_minus_cos == 0 || (direction - light.direction).length2() > 2 * light.one_minus_cos) return 0;
        return choice * pdf_cone(light.one_minus_cos);
    case LightKind::rectangle: {
        const double cosine = std::abs(light.normal.dot(direction));
        return cosine > 0 ? choice * distance * distance / (light.area * cosine) : 0;
    }
    case LightKind::sphere: {
        const double distance2 = (light.center - point).length2();
        return distance2 > light.radius * light.radius ? choice * pdf_cone(sphere_cone(light, distance2)) : 0;
    }
    }
    return 0;
}

double LightSet::meet(uint32_t index, const V3d& point, const V3d& direction) const
{
    constexpr double never = std::numeric_limits<double>::infinity();
    const Light& light = lights_[index];
    if (light.kind == LightKind::sphere) {
        const V3d to = light.center - point;
        const double along = to.dot(direction), rest = light.radius * light.radius - (to - along * direction).length2();
        const double t = along - safe_sqrt(rest);
        return rest > 0 && t > 0 ? t : never;
    }
    if (light.kind != LightKind::rectangle) return never;
    const double t = (light.corner - point).dot(light.normal) / direction.dot(light.normal);
    if (!(t > 0) || !std::isfinite(t)) return never;
    const V3d p = point + t * direction - light.corner;
    const V3d n = light.edge1.cross(light.edge2);
    const double u = p.cross(light.edge2).dot(n) / n.length2(), v = light.edge1.cross(p).dot(n) / n.length2();
    return u >= 0 && u <= 1 && v >= 0 && v <= 1 ? t : never;
}

Color LightSet::infinite_radiance(uint32_t index, const V3d& direction) const
{
    const Light& light = lights_[index];
    switch (light.kind) {
    case LightKind::constant: return light.radiance;
    case LightKind::environment: return light.map->radiance(direction);
    case LightKind::distant: // |a - b|^2 = 2 (1 - cos), without the cancellation of 1 - a.b
        return light.one_minus_cos > 0 && (direction - light.direction).length2() <= 2 * light.one_minus_cos
                   ? light.radiance
                   : Color(0);
    default: return Color(0);
    }
}

} // namespace scree
