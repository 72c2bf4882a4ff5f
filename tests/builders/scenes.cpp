#include "tests/builders/scenes.h"

#include "render/build/shell_builder.h"
#include "render/media/homogeneous_medium.h"

namespace scree {

TestScene::TestScene() : device_(std::make_shared<EmbreeDevice>()) {}

uint32_t TestScene::add_type(const Material& material)
{
    world_.types.push_back({"type" + std::to_string(world_.types.size()), material, nullptr});
    return static_cast<uint32_t>(world_.types.size() - 1);
}

uint32_t TestScene::add_type(const Material& material, const TriangleMesh& mesh)
{
    return add_type(material, std::make_shared<Exemplar>(*device_, mesh, "test mesh"));
}

uint32_t TestScene::add_type(const Material& material, std::shared_ptr<const Exemplar> exemplar)
{
    const uint32_t type = add_type(material);
    world_.types[type].exemplar = std::move(exemplar);
    return type;
}

void TestScene::add_proxies(const GsdfOptions& options)
{
    for (GrainType& type : world_.types) type.gsdf = build_gsdf({type.exemplar.get(), type.material}, options);
}

void TestScene::add_grain(const V3d& center, double radius, uint32_t type)
{
    grains_.push_back({center, radius, type});
}

void TestScene::add_grains(const std::vector<PackedSphere>& spheres, uint32_t type)
{
    for (const PackedSphere& s : spheres) add_grain(s.center, s.radius, type);
}

void TestScene::add_surface(const TriangleMesh& mesh, const Material& material)
{
    surfaces_.emplace_back(mesh, material);
}
void TestScene::add_medium(const TriangleMesh& mesh, const V3d& sigma_t, const Color& albedo, double g,
                           bool instead_of_grains)
{
    media_.push_back({mesh, sigma_t, albedo, g, instead_of_grains, nullptr});
}

void TestScene::add_medium(const TriangleMesh& mesh, const V3d& sigma_t, const Color& albedo,
                           std::shared_ptr<const PhaseTable> table)
{
    media_.push_back({mesh, sigma_t, albedo, 0, false, std::move(table)});
}

void TestScene::add_light(const Light& light) { lights_.push_back(light); }

void TestScene::add_constant_light(float radiance)
{
    Light light;
    light.kind = LightKind::constant;
    light.radiance = Color(radiance);
    add_light(light);
}

void TestScene::add_white_environment()
{
    Light light;
    light.kind = LightKind::environment;
    light.map = std::make_shared<EnvironmentMap>(std::vector<Color>(16 * 8, Color(1)), 16, 8, V3d(0, 0, 1), Color(1));
    add_light(light);
}

void TestScene::build()
{
    double extent = 0;
    for (const Grain& g : grains_) {
        for (int a = 0; a < 3; ++a) extent = std::max(extent, std::abs(g.center[a]) + g.radius);
    }
    if (extent > 0) std::frexp(extent, &world_.space.exponent);
    const RenderSpace& space = world_.space;
    for (GrainType& type : world_.types) type.material.absorption *= static_cast<float>(space.world_length(1));

    for (const bool meshes : {false, true}) {
        for (size_t i = 0; i < grains_.size(); ++i) {
            const Grain& g = grains_[i];
            if ((world_.types[g.type].exemplar != nullptr) != meshes) continue;
            const V3d p = space.point(g.center);
            world_.grains.spheres.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z),
                                             static_cast<float>(space.length(g.radius))});
            world_.grains.type_codes.push_back(static_cast<uint8_t>(g.type));
        }
        if (!meshes) world_.grains.analytic_count = world_.grains.size();
    }
    world_.grains.spheres.push_back({});
    world_.grains.widen();
    for (const auto& [mesh, material] : surfaces_) {
        Surface surface{"surface", {}, mesh.triangles, material};
        surface.material.absorption *= static_cast<float>(space.world_length(1));
        for (const V3d& p : mesh.positions) surface.positions.emplace_back(space.point(p));
        world_.surfaces.push_back(std::move(surface));
    }
    for (const Medium& medium : media_) {
        MediumRegion region{"medium", {}, medium.mesh.triangles, nullptr, nullptr, medium.instead_of_grains};
        for (const V3d& p : medium.mesh.positions) region.positions.emplace_back(space.point(p));
        const V3d sigma_t = medium.sigma_t * space.world_length(1);
        region.medium = medium.table ? std::make_shared<HomogeneousMedium>(sigma_t, medium.albedo, medium.table)
                                     : std::make_shared<HomogeneousMedium>(sigma_t, medium.albedo, medium.g);
        world_.regions.push_back(std::move(region));
    }
    for (Light& light : lights_) {
        light.corner = space.point(light.corner);
        light.edge1 = space.vector(light.edge1);
        light.edge2 = space.vector(light.edge2);
        light.center = space.point(light.center);
        light.radius = space.length(light.radius);
        if (light.kind == LightKind::rectangle) {
            const V3d cross = light.edge1.cross(light.edge2);
            light.area = cross.length();
            light.normal = cross.normalized();
        } else if (light.kind == LightKind::sphere) {
            light.area = 4 * pi * light.radius * light.radius;
        }
    }
    world_.lights = LightSet(lights_, 1.8);
    prepare_media(world_, shells_);
    tracer_ = std::make_unique<Tracer>(device_, world_);
}

void prepare_media(World& world, std::optional<StfForm> shells)
{
    world.clearance = make_clearance(world, Progress());
    if (!shells) return;
    static StfCache cache{{}}; // shared by all tests of a program
    std::vector<PartReport> parts;
    std::vector<std::string> remarks;
    add_shells({*shells}, cache, world, parts, remarks, Progress());
}

Material lambert(float reflectance)
{
    Material material;
    material.kind = MaterialKind::lambert;
    material.reflectance = Color(reflectance);
    return material;
}

Material dielectric(double ior, double alpha)
{
    Material material;
    material.kind = MaterialKind::dielectric;
    material.ior = ior;
    material.alpha = alpha;
    return material;
}

Light rectangle_light(const V3d& corner, const V3d& edge1, const V3d& edge2, float radiance)
{
    Light light;
    light.kind = LightKind::rectangle;
    light.corner = corner;
    light.edge1 = edge1;
    light.edge2 = edge2;
    light.radiance = Color(radiance);
    return light;
}

Light sphere_light(const V3d& center, double radius, float radiance)
{
    Light light;
    light.kind = LightKind::sphere;
    light.center = center;
    light.radius = radius;
    light.radiance = Color(radiance);
    return light;
}

Light distant_light(const V3d& direction, double one_minus_cos, float radiance)
{
    Light light;
    light.kind = LightKind::distant;
    light.direction = direction.normalized();
    light.one_minus_cos = one_minus_cos;
    light.radiance = Color(radiance);
    return light;
}

} // namespace scree
