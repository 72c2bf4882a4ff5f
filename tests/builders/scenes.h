#pragma once

#include "ingest/meshes/triangle_mesh.h"
#include "render/gsdf/gsdf_builder.h"
#include "render/stf/stf_form.h"
#include "render/trace/tracer.h"
#include "render/trace/world.h"
#include "tests/builders/packings.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// A world put together by hand, and the tracer over it: what tests and benchmarks render without a scene file.
class TestScene {
public:
    TestScene();

    /// A grain type; the shape is the bounding sphere, or a mesh. Returns its number.
    uint32_t add_type(const Material& material);
    uint32_t add_type(const Material& material, const TriangleMesh& mesh);
    uint32_t add_type(const Material& material, std::shared_ptr<const Exemplar> exemplar);
    /// The id of the first grain; the others follow.
    void set_first_id(uint64_t id) { world_.grains.first_id = id; }
    /// Gives every type its GSDF, so that grains may be proxies; after types are added.
    void add_proxies(const GsdfOptions& options);
    void set_gsdf(uint32_t type, std::shared_ptr<const Gsdf> gsdf) { world_.types[type].gsdf = std::move(gsdf); }
    void add_grain(const V3d& center, double radius, uint32_t type);
    void add_grains(const std::vector<PackedSphere>& spheres, uint32_t type);
    void add_surface(const TriangleMesh& mesh, const Material& material);
    /// sigma_t per unit of length. instead_of_grains: rays do not hit grains inside it.
    void add_medium(const TriangleMesh& mesh, const V3d& sigma_t, const Color& albedo, double g,
                    bool instead_of_grains = false);
    /// The same with a phase function of a table.
    void add_medium(const TriangleMesh& mesh, const V3d& sigma_t, const Color& albedo,
                    std::shared_ptr<const PhaseTable> table);
    void add_light(const Light& light);
    void add_constant_light(float radiance);
    /// Adds the same white light from all around, but as a light that is sampled.
    void add_white_environment();

    /// Light crosses media with shells where they fit.
    void use_shells(StfForm form = StfForm::full) { shells_ = form; }

    /// Builds; nothing may be added afterwards. Coordinates are scaled by a power of two so that the grains fill -1..1.
    void build();

    const World& world() const { return world_; }
    const Tracer& tracer() const { return *tracer_; }
    const EmbreeDevice& device() const { return *device_; }
    RenderSpace space() const { return world_.space; }

private:
    struct Grain {
        V3d center;
        double radius;
        uint32_t type;
    };
    std::shared_ptr<EmbreeDevice> device_;
    World world_;
    std::vector<Grain> grains_;
    std::vector<std::pair<TriangleMesh, Material>> surfaces_;
    struct Medium {
        TriangleMesh mesh;
        V3d sigma_t;
        Color albedo;
        double g;
        bool instead_of_grains;
        std::shared_ptr<const PhaseTable> table; ///< null: g decides
    };
    std::vector<Medium> media_;
    std::vector<Light> lights_;
    std::optional<StfForm> shells_;
    std::unique_ptr<Tracer> tracer_;
};

/// Gives a world its clearances and the media their shells; to be called before the tracer is made.
void prepare_media(World& world, std::optional<StfForm> shells);

Material lambert(float reflectance);
Material dielectric(double ior, double alpha = 0);

/// Lights as add_light() takes them.
Light rectangle_light(const V3d& corner, const V3d& edge1, const V3d& edge2, float radiance = 1);
Light sphere_light(const V3d& center, double radius, float radiance = 1);
/// direction: towards it, of any length.
Light distant_light(const V3d& direction, double one_minus_cos, float radiance);

} // namespace scree
