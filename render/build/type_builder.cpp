#include "render/build/type_builder.h"

#include "base/content_hash.h"
#include "render/grains/shape_source.h"
#include "render/gsdf/gsdf_cache.h"

#include <fmt/format.h>

namespace scree {

namespace {

ShapeSource shape_source(const GrainTypeDescription& type) { return {type.mesh, type.library, type.shape}; }

} // namespace

GsdfOptions gsdf_options(Accuracy accuracy) { return {.error = level_of(accuracy).gsdf_error}; }

std::shared_ptr<const Exemplar> TypeBuilder::make_exemplar(const GrainTypeDescription& type) const
{
    return scree::make_exemplar(*device_, shape_source(type), type.material, type.place + "/shape", type.name);
}

void TypeBuilder::add_exemplar(const GrainTypeDescription& type, Shape& shape, const BuildContext& context) const
{
    const std::string part = "exemplar '" + type.name + "'";
    if (!type.has_mesh()) {
        context.parts.push_back({part, false, "its shape is the bounding sphere itself"});
        return;
    }
    if (!context.plan.has_exemplars()) {
        context.parts.push_back({part, false, "no grain is traced as explicit geometry"});
        return;
    }
    const Stopwatch watch;
    if (!shape.exemplar) shape.exemplar = make_exemplar(type);
    const std::string source = type.library ? fmt::format(" of the library's {}", type.library->name) : "";
    context.parts.push_back({part, true, fmt::format("{} triangles{}", shape.exemplar->triangle_count(), source),
                             watch.seconds(), shape.exemplar->bytes()});
}

void TypeBuilder::add_gsdf(const GrainTypeDescription& type, Shape& shape, const BuildContext& context)
{
    const std::string part = "gsdf '" + type.name + "'";
    if (!context.plan.needs_gsdfs()) {
        context.parts.push_back({part, false, "no grain is a proxy, and no medium replaces grains"});
        return;
    }
    const GsdfOptions options = gsdf_options(context.plan.accuracy);
    GsdfSource source{shape.hash, type.material, nullptr};
    if (type.has_mesh()) {
        source.exemplar = [&] {
            if (!shape.exemplar) shape.exemplar = make_exemplar(type);
            return shape.exemplar;
        };
    }
    const Stopwatch watch;
    std::shared_ptr<const Gsdf>& gsdf = gsdfs_[gsdf_key(source, options)]; // types that differ only in colour share one
    std::string how = "already made for another type or frame";
    if (!gsdf) {
        const bool now = context.precompute == Precompute::now;
        const FoundGsdf found = now ? find_gsdf(source, options, cache_folder(), context.progress)
                                    : stored_gsdf(source, options, cache_folder());
        if (!found.remark.empty()) context.warnings.push_back(found.remark);
        if (!found.gsdf) {
            context.parts.push_back(
                {part, true, fmt::format("to be traced to an error of {:g} %; not in the cache", 100 * options.error)});
            return;
        }
        gsdf = found.gsdf;
        const GsdfQuality& quality = gsdf->data().quality;
        how = fmt::format("{}, {:.2g} paths, error {:.2g} %", found.computed ? "traced" : "from the cache",
                          static_cast<double>(quality.paths), 100 * quality.density_error);
        if (const std::string doubt = doubt_of(quality, options.error); !doubt.empty()) {
            context.warnings.push_back(fmt::format("the scattering of '{}': {}", type.name, doubt));
        }
    }
    shape.gsdf = gsdf;
    context.parts.push_back({part, true, how, watch.seconds(), gsdf->bytes()});
}

uint64_t TypeBuilder::build(const std::vector<GrainTypeDescription>& types, const std::vector<uint8_t>& used,
                            const BuildContext& context, World& world, uint64_t hash)
{
    for (size_t i = 0; i < types.size(); ++i) {
        const GrainTypeDescription& type = types[i];
        GrainType made{type.name, {}, nullptr};
        if (!used[i]) { // its material stays the default, so that nothing is built for it
            for (const char* part : {"exemplar", "gsdf"})
                context.parts.push_back({fmt::format("{} '{}'", part, type.name), false, "no grain has this type"});
        } else {
            made.material = type.material;
            made.material.absorption *= static_cast<Real>(world.space.world_length(1));
            const bool is_new = !shapes_.contains(type.name);
            Shape& shape = shapes_[type.name];
            if (is_new) shape.hash = hash_shape(shape_source(type));
            add_exemplar(type, shape, context);
            add_gsdf(type, shape, context);
            if (context.plan.has_exemplars())
                made.exemplar = shape.exemplar;
            else
                shape.exemplar = nullptr; // it was only needed to trace the GSDF
            made.gsdf = shape.gsdf;
            hash = mix64(hash ^ shape.hash);
        }
        world.types.push_back(std::move(made));
    }
    return hash;
}

} // namespace scree
