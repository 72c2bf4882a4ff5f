#pragma once

#include "base/math.h"
#include "render/lights/environment_map.h"

#include <memory>
#include <vector>

namespace scree {

enum class LightKind : uint8_t { constant, environment, distant, rectangle, sphere };

/// A source of light, in render coordinates. Rectangles shine from both faces, spheres outwards; neither reflects.
struct Light {
    LightKind kind = LightKind::constant;
    Color radiance{1}; ///< emitted; for distant the radiance of the disc (irradiance when it is a point)
    V3d direction{0, 0, 1}; ///< distant: unit, from the scene towards the light
    double one_minus_cos = 0; ///< distant: 1 - cos of half its angular diameter; 0 is a point
    V3d corner{0}, edge1{0}, edge2{0}; ///< rectangle
    V3d normal{0, 0, 1}; ///< rectangle: unit
    double area = 0; ///< rectangle, sphere
    V3d center{0}; ///< sphere
    double radius = 0; ///< sphere
    std::shared_ptr<const EnvironmentMap> map; ///< environment

    bool is_infinite() const { return kind <= LightKind::distant; }
    /// Whether next-event estimation samples the light; not for a constant one, which every ray that escapes finds.
    bool is_sampled() const { return kind != LightKind::constant; }
};

struct LightSample {
    V3d direction{0}; ///< unit, from the point towards the light
    double distance = 0; ///< to the light; infinity where it is infinite
    Color radiance{0}; ///< that arrives if nothing is in the way
    double pdf = 0; ///< per solid angle, times the probability of choosing the light; for a point light only the latter
    bool delta = false;
    uint32_t light = 0;
    bool valid = false;
};

/// All lights of a scene, and the random choice among the sampled ones (by a rough power).
class LightSet {
public:
    LightSet() = default;
    /// scene_radius: of the sphere around everything, in render coordinates; it only weighs infinite lights against
    /// finite ones.
    LightSet(std::vector<Light> lights, double scene_radius);

    const std::vector<Light>& lights() const { return lights_; }
    /// Whether next-event estimation has anything to sample.
    bool any_sampled() const { return any_sampled_; }

    LightSample sample(const V3d& point, double u_choice, double u1, double u2) const;
    /// Density with which `sample` at `point` gives `direction` through light `index`. distance: to a finite light.
    double pdf(uint32_t index, const V3d& point, const V3d& direction, double distance) const;
    /// Distance at which the ray hits a finite light if nothing is in the way; infinity if it misses the light.
    double meet(uint32_t index, const V3d& point, const V3d& direction) const;
    /// Radiance of a finite light seen along `direction`.
    Color emitted(uint32_t index) const { return lights_[index].radiance; }
    /// Radiance of one infinite light seen along `direction`.
    Color infinite_radiance(uint32_t index, const V3d& direction) const;

private:
    std::vector<Light> lights_;
    std::vector<double> choice_; // probability of each light
    std::vector<double> cumulated_; // size + 1
    bool any_sampled_ = false;
};

} // namespace scree
