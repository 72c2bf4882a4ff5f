#include "mixtures/make_mixture.h"

#include "base/error.h"
#include "base/hash.h"
#include "mixtures/blend_mixture.h"
#include "mixtures/explicit_mixture.h"
#include "mixtures/grid_mixture.h"
#include "mixtures/layers_mixture.h"
#include "mixtures/perlin_mixture.h"
#include "mixtures/random_mixture.h"
#include "mixtures/single_mixture.h"
#include "mixtures/type_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace scree {

namespace {

/// Makes one node of the tree; a blend creates a Maker for each of its mixtures.
struct Maker {
    const MixtureContext& context;
    const std::vector<std::string>& types; // of this level: the scene's grain types, or the mixture names of a blend
    const SphereIds& ids;
    Imath::V3d origin;
    uint64_t stream;
    const std::string& place;

    uint32_t type_of(const std::string& name) const
    {
        const auto it = std::ranges::find(types, name);
        if (it != types.end()) return static_cast<uint32_t>(it - types.begin());
        const std::string nearest = did_you_mean(name, types);
        throw InputError(place, "the grain type '" + name + "'", fmt::format("one of {}", fmt::join(types, ", ")),
                         nearest.empty() ? "" : nearest.substr(2));
    }
    std::vector<uint32_t> types_of(const std::vector<std::string>& names) const
    {
        std::vector<uint32_t> result;
        for (const std::string& name : names) result.push_back(type_of(name));
        return result;
    }
    const ParticleFrame& spheres(const char* kind) const
    {
        if (!context.frame)
            throw InputError(place, std::string("a mixture of kind ") + kind, "a scene with a list of spheres", "");
        return *context.frame;
    }
    std::unique_ptr<Mixture> for_spheres(std::unique_ptr<Mixture> mixture) const
    {
        if (!context.tiled) return mixture;
        return std::make_unique<TiledMixture>(std::move(mixture), context.frame->size());
    }

    std::unique_ptr<Mixture> operator()(const SingleDescription& mixture) const
    {
        return std::make_unique<SingleMixture>(type_of(mixture.type));
    }

    std::unique_ptr<Mixture> operator()(const ExplicitDescription& mixture) const
    {
        const ParticleFrame& frame = spheres("explicit");
        std::map<std::string, std::string> names = mixture.types;
        if (names.empty())
            for (const auto& [number, name] : context.file_types) names[std::to_string(number)] = name;
        if (mixture.table.empty()) {
            std::map<int32_t, uint32_t> map;
            std::set<int32_t> met;
            for (const int32_t number : frame.type) {
                if (!met.insert(number).second) continue;
                const auto name = names.find(std::to_string(number));
                if (name != names.end())
                    map[number] = type_of(name->second);
                else if (names.empty() && types.size() == 1)
                    map[number] = 0;
            }
            return for_spheres(
                mixture_from_frame(frame, map, mixture.types.empty() ? context.place : place + "/types"));
        }
        const TypeTable table = read_type_table(mixture.table, mixture.column, mixture.id);
        std::vector<uint32_t> map;
        for (const std::string& word : table.words) {
            const auto name = names.find(word);
            if (name != names.end()) {
                map.push_back(type_of(name->second));
            } else if (std::ranges::find(types, word) != types.end()) {
                map.push_back(type_of(word));
            } else {
                throw InputError(mixture.table.string(), "the type " + word,
                                 "a key of \"types\", or the name of a grain type",
                                 fmt::format("e.g. \"types\": {{\"{}\": \"{}\"}} in {}", word,
                                             types.empty() ? "glass" : types[0], place));
            }
        }
        return for_spheres(mixture_from_table(table, map, frame, mixture.table.string()));
    }

    std::unique_ptr<Mixture> operator()(const RandomDescription& mixture) const
    {
        const std::vector<uint32_t> numbers = types_of(mixture.types);
        if (mixture.by == RandomBy::volume && context.frame && !context.tiled) {
            std::vector<uint32_t> chosen =
                choose_by_volume(context.frame->radius, ids, mixture.weights, mixture.seed, stream);
            for (uint32_t& type : chosen) type = numbers[type];
            return std::make_unique<ExplicitMixture>(chosen);
        }
        return std::make_unique<RandomMixture>(numbers, mixture.weights, mixture.seed, stream, ids);
    }

    std::unique_ptr<Mixture> operator()(const PerlinDescription& mixture) const
    {
        std::vector<double> thresholds = mixture.threshold;
        if (!mixture.fraction.empty()) {
            double all = 0, sum = 0;
            std::vector<double> below;
            for (const double f : mixture.fraction) all += f;
            for (size_t k = 0; k + 1 < mixture.fraction.size(); ++k)
                below.push_back((sum += mixture.fraction[k]) / all);
            thresholds = FractalNoise(mixture.noise).quantiles(below);
        }
        return std::make_unique<PerlinMixture>(mixture.noise, types_of(mixture.types), thresholds, origin);
    }

    std::unique_ptr<Mixture> operator()(const CheckerboardDescription& mixture) const
    {
        return std::make_unique<CheckerboardMixture>(mixture.board, types_of(mixture.types), origin);
    }

    std::unique_ptr<Mixture> operator()(const LayersDescription& mixture) const
    {
        const LayersMixture::Layers layers{mixture.direction, mixture.thicknesses, mixture.offset,
                                           mixture.repeat,    mixture.jitter,      mixture.noise};
        return std::make_unique<LayersMixture>(layers, types_of(mixture.types), origin);
    }

    std::unique_ptr<Mixture> operator()(const RadiusDescription& mixture) const
    {
        const std::vector<uint32_t> numbers = types_of(mixture.types);
        std::vector<uint32_t> chosen;
        for (const double r : spheres("radius").radius) {
            const auto above = std::ranges::upper_bound(mixture.thresholds, r);
            chosen.push_back(numbers[static_cast<size_t>(above - mixture.thresholds.begin())]);
        }
        return for_spheres(std::make_unique<ExplicitMixture>(chosen));
    }

    std::unique_ptr<Mixture> operator()(const GridDescription& mixture) const
    {
        GridMixture::Options options;
        for (const auto& field : mixture.fields)
            options.fields.push_back({type_of(field.type), field.file, field.grid});
        if (!mixture.rest.empty()) options.rest = type_of(mixture.rest);
        options.seed = mixture.seed;
        options.stream = stream;
        return std::make_unique<GridMixture>(options, ids, origin);
    }

    std::unique_ptr<Mixture> operator()(const BlendDescription& mixture) const
    {
        std::vector<std::unique_ptr<Mixture>> mixtures;
        for (size_t k = 0; k < mixture.mixtures.size(); ++k) {
            Maker inner{context,
                        types,
                        ids,
                        origin,
                        mix64(stream + (k + 1) * 0x9e3779b97f4a7c15ull),
                        mixture.mixtures[k].place};
            mixtures.push_back(std::visit(inner, mixture.mixtures[k].kind));
        }
        const Maker chooser{context, mixture.names, ids, origin, stream, mixture.by[0].place};
        return std::make_unique<BlendMixture>(std::visit(chooser, mixture.by[0].kind), std::move(mixtures));
    }
};

} // namespace

std::unique_ptr<Mixture> make_mixture(const MixtureDescription& description, const MixtureContext& context)
{
    const ParticleFrame* frame = context.frame;
    if (frame && frame->size() == 0) return std::make_unique<SingleMixture>(0); // no sphere will ask
    const SphereIds ids = frame && !context.tiled ? SphereIds(frame->id) : SphereIds();
    const Maker maker{context, context.types, ids, frame ? frame->origin : Imath::V3d(0), 0, description.place};
    return std::visit(maker, description.kind);
}

} // namespace scree
