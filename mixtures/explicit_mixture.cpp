#include "mixtures/explicit_mixture.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace scree {

ExplicitMixture::ExplicitMixture(const std::vector<uint32_t>& types)
{
    const uint32_t highest = types.empty() ? 0 : *std::max_element(types.begin(), types.end());
    if (highest > 0xffff) throw std::out_of_range("an explicit mixture holds types below 65536");
    if (highest > 0xff)
        wide_.assign(types.begin(), types.end());
    else
        narrow_.assign(types.begin(), types.end());
}

std::optional<std::set<uint32_t>> ExplicitMixture::possible_types() const
{
    std::set<uint32_t> types(wide_.begin(), wide_.end());
    types.insert(narrow_.begin(), narrow_.end());
    return types;
}

std::unique_ptr<ExplicitMixture> mixture_from_frame(const ParticleFrame& frame,
                                                    const std::map<int32_t, uint32_t>& type_map,
                                                    const std::string& place)
{
    std::vector<uint32_t> types(frame.size());
    std::set<int32_t> missing;
    auto last = type_map.end(); // neighbours mostly share their type
    for (size_t i = 0; i < frame.size(); ++i) {
        if (last == type_map.end() || last->first != frame.type[i]) last = type_map.find(frame.type[i]);
        if (last == type_map.end())
            missing.insert(frame.type[i]);
        else
            types[i] = last->second;
    }
    if (!missing.empty()) {
        throw InputError(place, fmt::format("no grain type for the dump's type {}", fmt::join(missing, ", ")),
                         "a grain type for every type of the dump",
                         fmt::format("e.g. \"{}\": \"glass\"", *missing.begin()));
    }
    return std::make_unique<ExplicitMixture>(types);
}

} // namespace scree
