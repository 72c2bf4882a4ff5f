#include "render/build/world_builder.h"

#include "base/content_hash.h"
#include "base/error.h"
#include "ingest/meshes/mesh_hash.h"
#include "ingest/meshes/triangle_mesh.h"
#include "ingest/particles/particle_series.h"
#include "mixtures/mixture_series.h"
#include "render/build/fill_builder.h"
#include "render/build/grain_facts.h"
#include "render/build/light_builder.h"
#include "render/build/medium_builder.h"
#include "render/build/mixture_hash.h"
#include "render/build/planned_media.h"
#include "render/lights/environment_file.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>

namespace scree {

namespace {

/// The space of a box: its middle as origin, and its size rounded to a power of two as scale.
RenderSpace space_of(const Imath::Box3d& box)
{
    RenderSpace space;
    space.origin = 0.5 * box.min + 0.5 * box.max;
    const V3d half = 0.5 * (box.max - box.min);
    const double size = std::max({half.x, half.y, half.z});
    if (size > 0) std::frexp(size, &space.exponent);
    return space;
}

/// Bounds of points; space() gives their render space.
struct Bounds {
    V3d lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};

    void extend(const V3d& p, double r = 0)
    {
        for (int i = 0; i < 3; ++i) {
            lo[i] = std::min(lo[i], p[i] - r);
            hi[i] = std::max(hi[i], p[i] + r);
        }
    }
    bool empty() const { return !(lo.x <= hi.x); }
    RenderSpace space() const { return empty() ? RenderSpace() : space_of({lo, hi}); }
};

/// The middle of the bounds. If a few grains are so far away that this would cost the others their precision: the
/// median of each axis.
V3d scene_origin(const std::vector<V3d>& points, const Bounds& bounds)
{
    constexpr double far = 1000; // in widths of the middle half of the grains' positions
    const V3d middle = bounds.space().origin;
    const size_t n = points.size();
    if (n < 16) return middle;
    V3d median;
    double width = 0, reach = 0;
    std::vector<double> values(n);
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::transform(points, values.begin(), [axis](const V3d& p) { return p[axis]; });
        const auto quantile = [&](size_t index) {
            const auto place = values.begin() + static_cast<std::ptrdiff_t>(index);
            std::ranges::nth_element(values, place);
            return *place;
        };
        width = std::max(width, quantile(3 * n / 4) - quantile(n / 4));
        median[axis] = quantile(n / 2);
        reach = std::max({reach, bounds.hi[axis] - median[axis], median[axis] - bounds.lo[axis]});
    }
    return reach > far * width && width > 0 ? median : middle;
}

/// Centres the scene on the domain that its grains fill, so that a fill and the list of its spheres have the same
/// coordinates to the bit.
void set_domain(const Imath::Box3d& domain, World& world)
{
    world.space = space_of(domain);
    world.domain = Imath::Box3d(world.space.point(domain.min), world.space.point(domain.max));
}

/// The scene's spheres from any source, with the grain type of each.
struct Spheres {
    ParticleFrame frame;
    std::vector<uint8_t> types;
};

} // namespace

struct WorldBuilder::Impl {
    const SceneDescription scene;
    std::shared_ptr<EmbreeDevice> device = std::make_shared<EmbreeDevice>();
    std::unique_ptr<ParticleSeries> series; ///< null without a dump
    std::optional<MixtureSeries> mixtures;
    std::optional<BuiltFill> fill;
    TypeBuilder types{device};
    MediumBuilder media{scene};
    std::vector<TriangleMesh> surfaces;
    std::map<size_t, std::shared_ptr<const EnvironmentMap>> maps; // by light
    PlannedShells shells;

    explicit Impl(SceneDescription s) : scene(std::move(s)) {}
    Spheres read_spheres(size_t frame, const Progress& progress);
    TransportPlan decide(const GrainFacts& facts) const;
    GrainStore make_grains(Spheres spheres, const BuildContext& context, World& world, BuiltFrame& built);
    void make_fill(const BuildContext& context, World& world, BuiltFrame& built);
    TriangleMesh read_surface(const SurfaceDescription& surface) const;
    void make_surfaces(World& world, BuiltFrame& built);
    LightSet make_lights(const World& world, BuiltFrame& built);
    std::shared_ptr<const EnvironmentMap> read_map(size_t light, BuiltFrame& built);
    std::optional<MixtureSeries> make_mixtures() const;
    ParticleFrame read_dump(size_t frame, const Progress& progress) const;
};

std::optional<MixtureSeries> WorldBuilder::Impl::make_mixtures() const
{
    if (!scene.assembly || scene.assembly->fill) return std::nullopt;
    std::vector<std::string> names;
    for (const GrainTypeDescription& type : scene.types) names.push_back(type.name);
    std::map<int32_t, std::string> file_types = scene.assembly->types;
    if (scene.assembly->dump
            .empty()) { // spheres of the scene file: read_spheres numbers types by their place in the list
        for (size_t i = 0; i < names.size(); ++i) file_types[static_cast<int32_t>(i)] = names[i];
    }
    return MixtureSeries(scene.mixture, names, file_types, scene.assembly->place + "/types");
}

ParticleFrame WorldBuilder::Impl::read_dump(size_t frame, const Progress& progress) const
{
    return series->read(frame, {scene.assembly->radius, scene.assembly->radius_of_type}, progress);
}

Spheres WorldBuilder::Impl::read_spheres(size_t number, const Progress& progress)
{
    Spheres spheres;
    ParticleFrame& frame = spheres.frame;
    if (series) {
        frame = read_dump(number, progress);
        if (const auto deciding = mixtures->deciding_frame(series->frame_count()); deciding && !mixtures->decided()) {
            mixtures->decide(*deciding == number ? frame : read_dump(*deciding, progress));
        }
    } else {
        for (const auto& sphere : scene.assembly->spheres) {
            frame.id.push_back(frame.id.size());
            frame.position.push_back(sphere.center);
            frame.radius.push_back(static_cast<float>(sphere.radius));
            const auto named = std::ranges::find(scene.types, sphere.type, &GrainTypeDescription::name);
            frame.type.push_back(named == scene.types.end() ? 0 : static_cast<int32_t>(named - scene.types.begin()));
        }
        frame.has_ids = true;
    }
    const std::unique_ptr<Mixture> mixture = mixtures->mixture(frame);
    spheres.types.resize(frame.size());
    tbb::parallel_for(size_t{0}, frame.size(), [&](size_t i) {
        spheres.types[i] = static_cast<uint8_t>(mixture->type(i, frame.relative_position(i)));
    });
    return spheres;
}

TransportPlan WorldBuilder::Impl::decide(const GrainFacts& facts) const
{
    TransportPlan plan = plan_transport(scene.integrator, scene.camera, scene.film, facts);
    if (scene.media.empty() && !plan.has_grain_medium) plan.has_shells = false;
    return plan;
}

GrainStore WorldBuilder::Impl::make_grains(Spheres spheres, const BuildContext& context, World& world,
                                           BuiltFrame& built)
{
    const ParticleFrame& frame = spheres.frame;
    Bounds bounds; // without grains of radius 0, which are not in the world
    std::vector<uint8_t> used(scene.types.size(), 0);
    for (size_t i = 0; i < frame.size(); ++i) {
        if (!(frame.radius[i] > 0)) continue;
        used[spheres.types[i]] = 1;
        bounds.extend(frame.position[i], frame.radius[i]);
    }
    built.plan = decide(facts_of_list(frame, spheres.types, scene.types));
    if (frame.domain) {
        set_domain(*frame.domain, world);
    } else {
        world.space = bounds.space();
        world.space.origin = scene_origin(frame.position, bounds);
    }

    built.hash = types.build(scene.types, used, context, world, built.hash);

    GrainStore grains;
    uint64_t without_size = 0;
    const auto add = [&](size_t i) {
        const uint32_t type = spheres.types[i];
        const V3d p = world.space.point(frame.position[i]);
        const auto r = static_cast<float>(world.space.length(frame.radius[i]));
        if (!(r >= std::numeric_limits<float>::min())) { // also radii that underflow: no ray could hit them
            ++without_size;
            return;
        }
        grains.spheres.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), r});
        grains.type_codes.push_back(static_cast<uint8_t>(type));
        grains.ids.push_back(frame.id[i]);
        if (!frame.orientation.empty() && world.types[type].exemplar)
            grains.orientation.push_back(frame.orientation[i]);
    };
    grains.spheres.reserve(frame.size() + 1);
    grains.type_codes.reserve(frame.size());
    grains.ids.reserve(frame.size());
    for (const bool meshes : {false, true}) {
        for (size_t i = 0; i < frame.size(); ++i) {
            if ((world.types[spheres.types[i]].exemplar != nullptr) == meshes) add(i);
        }
        if (!meshes) grains.analytic_count = grains.size();
    }
    grains.spheres.push_back({});
    bool consecutive = true;
    for (size_t i = 1; i < grains.ids.size() && consecutive; ++i) consecutive = grains.ids[i] == grains.ids[0] + i;
    if (consecutive) {
        grains.first_id = grains.ids.empty() ? 0 : grains.ids[0];
        grains.ids = {};
    }
    grains.widen();
    if (without_size > 0) built.warnings.push_back(fmt::format("{} grains of radius 0 are left out", without_size));
    built.hash = hash_vector(grains.type_codes,
                             hash_vector(frame.radius, hash_vector(frame.position, hash_vector(frame.id, built.hash))));
    built.hash = hash_vector(frame.orientation, built.hash);
    return grains;
}

void WorldBuilder::Impl::make_fill(const BuildContext& context, World& world, BuiltFrame& built)
{
    if (!fill) fill = build_fill(scene);
    built.parts.insert(built.parts.end(), fill->parts.begin(), fill->parts.end());
    built.warnings.insert(built.warnings.end(), fill->remarks.begin(), fill->remarks.end());
    const ProceduralFill& spheres = *fill->fill;
    set_domain(spheres.domain().bounds(), world);
    world.fill = std::make_shared<GrainFill>(fill->fill, fill->mixture, world.space);
    built.plan = decide(facts_of_fill(*world.fill, scene.types));
    std::vector<uint8_t> used(scene.types.size(), 1);
    if (const auto possible = fill->mixture->possible_types()) {
        for (uint32_t type = 0; type < used.size(); ++type) used[type] = possible->contains(type);
    }
    built.hash = types.build(scene.types, used, context, world, built.hash);
    built.hash = hash_mesh(spheres.domain().mesh(), hash_mixture(scene.mixture, scene.file.parent_path(), built.hash));
    built.hash = hash_vector(spheres.tile().radius, hash_vector(spheres.tile().type, built.hash));
    for (const auto& variant : spheres.tile().variants) built.hash = hash_vector(variant, built.hash);
}

TriangleMesh WorldBuilder::Impl::read_surface(const SurfaceDescription& surface) const
{
    return surface.material.transmits() ? read_closed_mesh(surface.mesh, "as its material is a dielectric")
                                        : read_mesh(surface.mesh);
}

void WorldBuilder::Impl::make_surfaces(World& world, BuiltFrame& built)
{
    const Stopwatch watch;
    if (surfaces.empty()) {
        for (const auto& surface : scene.surfaces) surfaces.push_back(read_surface(surface));
    }
    const std::vector<V3d> around_media = media.read();
    if (!world.has_grains()) {
        Bounds bounds;
        for (const V3d& p : around_media) bounds.extend(p);
        for (const auto& mesh : surfaces) {
            for (const V3d& p : mesh.positions) bounds.extend(p);
        }
        world.space = bounds.space();
    }
    uint64_t triangles = 0, bytes = 0;
    for (size_t i = 0; i < surfaces.size(); ++i) {
        Surface surface;
        surface.name = scene.surfaces[i].mesh.filename().string();
        surface.material = scene.surfaces[i].material;
        surface.material.absorption *= static_cast<Real>(world.space.world_length(1));
        surface.triangles = surfaces[i].triangles;
        surface.positions.reserve(surfaces[i].positions.size());
        for (const V3d& p : surfaces[i].positions) surface.positions.emplace_back(world.space.point(p));
        triangles += surface.triangles.size();
        bytes += surface.triangles.size() * sizeof(surface.triangles[0]) + surface.positions.size() * sizeof(V3f);
        built.hash = hash_mesh(surfaces[i], built.hash);
        world.surfaces.push_back(std::move(surface));
    }
    if (surfaces.empty())
        built.parts.push_back({"surfaces", false, "the scene has none"});
    else
        built.parts.push_back({"surfaces", true, fmt::format("{} meshes, {} triangles", surfaces.size(), triangles),
                               watch.seconds(), bytes});
}

/// The map of an environment light, read once; null for other lights.
std::shared_ptr<const EnvironmentMap> WorldBuilder::Impl::read_map(size_t light, BuiltFrame& built)
{
    const LightDescription& description = scene.lights[light];
    if (description.kind != LightDescription::Kind::environment) return nullptr;
    auto& map = maps[light];
    const Stopwatch watch;
    if (!map)
        map = std::make_shared<EnvironmentMap>(read_environment(description.file, description.up, description.scale));
    built.parts.push_back({"environment map", true, description.file.filename().string(), watch.seconds(),
                           map->texels().size() * sizeof(Color)});
    built.hash = hash_vector(map->texels(), built.hash);
    return map;
}

LightSet WorldBuilder::Impl::make_lights(const World& world, BuiltFrame& built)
{
    std::vector<Light> lights;
    bool point = false, glass = false;
    if (std::ranges::none_of(scene.lights, [](const LightDescription& light) {
            return light.kind == LightDescription::Kind::environment;
        })) {
        built.parts.push_back({"environment map", false, "no light has one"});
    }
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        lights.push_back(make_light(scene.lights[i], read_map(i, built), world.space));
        point |= lights.back().kind == LightKind::distant && lights.back().one_minus_cos == 0;
    }
    if (world.has_grains()) {
        for (const GrainType& type : world.types) glass |= type.material.transmits() || type.material.is_delta();
    }
    for (const Surface& surface : world.surfaces) glass |= surface.material.transmits() || surface.material.is_delta();
    if (point && glass) {
        built.warnings.push_back(
            "a distant light of angle 0 cannot be found by paths through glass: its caustics are missing");
    }
    double radius2 = world.has_grains() ? 1.0 : 0.0;
    for (const Surface& surface : world.surfaces) {
        for (const V3f& p : surface.positions) radius2 = std::max(radius2, V3d(p).length2());
    }
    for (const MediumRegion& region : world.regions) {
        for (const V3f& p : region.positions) radius2 = std::max(radius2, V3d(p).length2());
    }
    return LightSet(std::move(lights), std::sqrt(radius2));
}

WorldBuilder::WorldBuilder(SceneDescription scene) : impl_(std::make_unique<Impl>(std::move(scene)))
{
    if (impl_->scene.types.size() > 256) {
        throw InputError(impl_->scene.file.string() + ": /grains/types",
                         fmt::format("{} grain types", impl_->scene.types.size()), "at most 256");
    }
    const auto& assembly = impl_->scene.assembly;
    if (assembly && !assembly->dump.empty()) impl_->series = open_particles(assembly->dump).series;
    impl_->mixtures = impl_->make_mixtures();
}

WorldBuilder::~WorldBuilder() = default;

const SceneDescription& WorldBuilder::scene() const { return impl_->scene; }
size_t WorldBuilder::frame_count() const { return impl_->series ? impl_->series->frame_count() : 1; }
std::shared_ptr<const EmbreeDevice> WorldBuilder::device() const { return impl_->device; }

BuiltFrame WorldBuilder::build(size_t frame, const Progress& progress, Precompute precompute)
{
    Impl& impl = *impl_;
    const SceneDescription& scene = impl.scene;
    BuiltFrame built;
    built.frame = frame;
    built.hash = hash_bytes(scene.canonical.data(), scene.canonical.size(), frame);
    built.plan = impl.decide({});
    if (impl.series) built.warnings = impl.series->warnings();
    const auto world = std::make_shared<World>();
    const BuildContext context{built.plan, precompute, progress, built.parts, built.warnings};
    if (scene.assembly && scene.assembly->fill) {
        impl.make_fill(context, *world, built);
    } else if (scene.assembly) {
        const Stopwatch watch;
        Spheres spheres = impl.read_spheres(frame, progress);
        if (impl.series)
            built.name = fmt::format("{} step {}", impl.series->file(frame).filename().string(), spheres.frame.step);
        const uint64_t read = spheres.frame.size();
        const double read_seconds = watch.seconds();
        world->grains = impl.make_grains(std::move(spheres), context, *world, built);
        built.parts.push_back({"grains", true, fmt::format("{} of {} spheres read", world->grains.size(), read),
                               read_seconds, world->grains.bytes()});
    } else {
        built.parts.push_back({"grains", false, "the scene has none"});
    }
    impl.make_surfaces(*world, built);
    built.hash = impl.media.build(*world, context, built.hash);
    if (scene.media.empty()) built.parts.push_back({"medium", false, "the scene has none"});
    if (built.plan.replaces_all && (scene.integrator.grain_depth || scene.integrator.grain_flights)) {
        built.warnings.push_back(
            "grain_depth and grain_flights have no effect with vpt and stf, which trace no grains");
    }
    built.medium_depth = make_planned_medium(context, *world);
    world->lights = impl.make_lights(*world, built);
    impl.shells.make(context, impl.media, *world);
    built.world = world;
    return built;
}

} // namespace scree
