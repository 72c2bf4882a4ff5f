#include "render/scene/type_builder.h"

#include "ingest/support/error.h"
#include "render/scene/content_hash.h"

#include <fmt/format.h>

namespace scree {

TypeBuilder::Shape TypeBuilder::make_shape(const GrainTypeDescription& type) const
{
    const std::string place = type.mesh ? type.mesh->string() : type.place + "/shape";
    const TriangleMesh mesh = type.mesh ? read_mesh(*type.mesh) : make_grain_shape(*type.library, type.shape, place);
    auto exemplar = std::make_shared<Exemplar>(*device_, mesh, place);
    if (type.material.transmits() && !exemplar->closed()) {
        throw InputError(place, "an open or inconsistently oriented mesh", "a closed mesh, as the material of '" + type.name + "' is a dielectric",
                         "close it, or give the type an opaque material");
    }
    return {std::move(exemplar), type.mesh ? hash_mesh(mesh, 1) : hash_shape(*type.library, type.shape)};
}

uint64_t TypeBuilder::build(const std::vector<GrainTypeDescription>& types, const std::vector<uint8_t>& used, World& world,
                            std::vector<PartReport>& parts, uint64_t hash)
{
    for (size_t i = 0; i < types.size(); ++i) {
        const GrainTypeDescription& type = types[i];
        GrainType made{type.name, type.material, nullptr};
        made.material.absorption *= static_cast<float>(world.space.world_length(1));
        const std::string part = "exemplar '" + type.name + "'";
        if (!used[i]) {
            parts.push_back({part, false, "no grain has this type"});
        } else if (!type.has_mesh()) {
            parts.push_back({part, false, "its shape is the bounding sphere itself"});
        } else {
            Shape& shape = shapes_[type.name];
            const Stopwatch watch;
            if (!shape.exemplar) shape = make_shape(type);
            made.exemplar = shape.exemplar;
            hash = mix64(hash ^ shape.hash);
            const std::string source = type.library ? fmt::format(" of the library's {}", type.library->name) : "";
            parts.push_back({part, true, fmt::format("{} triangles{}", shape.exemplar->triangle_count(), source), watch.seconds(),
                             shape.exemplar->bytes()});
        }
        world.types.push_back(std::move(made));
    }
    return hash;
}

} // namespace scree
