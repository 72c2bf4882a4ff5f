#include "render/build/light_builder.h"

namespace scree {

Light make_light(const LightDescription& description, const std::shared_ptr<const EnvironmentMap>& map,
                 const RenderSpace& space)
{
    using Kind = LightDescription::Kind;
    Light light;
    light.kind = static_cast<LightKind>(description.kind);
    light.radiance = description.radiance;
    switch (description.kind) {
    case Kind::constant: break;
    case Kind::environment: light.map = map; break;
    case Kind::distant: {
        light.direction = -description.direction.normalized();
        const double half = description.angle * pi / 360, sine = std::sin(half / 2);
        light.one_minus_cos = 2 * sine * sine;
        light.radiance = description.irradiance;
        // A disc of constant radiance L overhead gives the irradiance pi L sin^2(half).
        if (half > 0) light.radiance *= static_cast<Real>(1 / (pi * std::sin(half) * std::sin(half)));
        break;
    }
    case Kind::rectangle: {
        light.corner = space.point(description.corner);
        light.edge1 = space.vector(description.edge1);
        light.edge2 = space.vector(description.edge2);
        const V3d cross = light.edge1.cross(light.edge2);
        light.area = cross.length();
        light.normal = cross.normalized();
        break;
    }
    case Kind::sphere:
        light.center = space.point(description.center);
        light.radius = space.length(description.radius);
        light.area = 4 * pi * light.radius * light.radius;
        break;
    }
    return light;
}

} // namespace scree
