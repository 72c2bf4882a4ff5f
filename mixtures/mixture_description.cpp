#include "mixtures/mixture_description.h"

#include <algorithm>
#include <type_traits>

namespace scree {

namespace {

void add(std::vector<std::string>& names, const std::string& name)
{
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

void add_types(const MixtureDescription& mixture, bool chosen_only, std::vector<std::string>& names)
{
    std::visit(
        [&](const auto& kind) {
            using Kind = std::decay_t<decltype(kind)>;
            if constexpr (std::is_same_v<Kind, SingleDescription>) {
                add(names, kind.type);
            } else if constexpr (std::is_same_v<Kind, ExplicitDescription>) {
                for (const auto& [number, name] : kind.types) add(names, name);
            } else if constexpr (std::is_same_v<Kind, GridDescription>) {
                for (const auto& field : kind.fields) add(names, field.type);
                if (!kind.rest.empty()) add(names, kind.rest);
            } else if constexpr (std::is_same_v<Kind, BlendDescription>) {
                const std::vector<std::string> picked = types_named(kind.by[0], chosen_only);
                const bool by_dump = needs_dump_types(kind.by[0]);
                for (size_t k = 0; k < kind.names.size(); ++k) {
                    const bool can = by_dump || std::ranges::find(picked, kind.names[k]) != picked.end();
                    if (can || !chosen_only) add_types(kind.mixtures[k], chosen_only, names);
                }
            } else {
                for (size_t k = 0; k < kind.types.size(); ++k) {
                    bool never = false;
                    if constexpr (std::is_same_v<Kind, RandomDescription>) never = kind.weights[k] == 0;
                    if constexpr (std::is_same_v<Kind, PerlinDescription>)
                        never = !kind.fraction.empty() && kind.fraction[k] == 0;
                    if (!never || !chosen_only) add(names, kind.types[k]);
                }
            }
        },
        mixture.kind);
}

} // namespace

std::vector<std::string> types_named(const MixtureDescription& mixture, bool chosen_only)
{
    std::vector<std::string> names;
    add_types(mixture, chosen_only, names);
    return names;
}

bool depends_on_frame(const MixtureDescription& mixture)
{
    if (const auto* blend = std::get_if<BlendDescription>(&mixture.kind))
        return depends_on_frame(blend->by[0]) || std::ranges::any_of(blend->mixtures, depends_on_frame);
    if (const auto* random = std::get_if<RandomDescription>(&mixture.kind)) return random->by == RandomBy::volume;
    return !std::holds_alternative<SingleDescription>(mixture.kind) &&
           !std::holds_alternative<ExplicitDescription>(mixture.kind) &&
           !std::holds_alternative<RadiusDescription>(mixture.kind);
}

bool needs_dump_types(const MixtureDescription& mixture)
{
    if (const auto* blend = std::get_if<BlendDescription>(&mixture.kind))
        return needs_dump_types(blend->by[0]) || std::ranges::any_of(blend->mixtures, needs_dump_types);
    const auto* table = std::get_if<ExplicitDescription>(&mixture.kind);
    return table && table->types.empty();
}

} // namespace scree
