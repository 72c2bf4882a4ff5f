#include "render/build/mixture_hash.h"

#include "base/content_hash.h"
#include "mixtures/read_mixture.h"

#include <nlohmann/json.hpp>

namespace scree {

namespace {

uint64_t hash_files(const MixtureDescription& mixture, uint64_t hash)
{
    if (const auto* listed = std::get_if<ExplicitDescription>(&mixture.kind); listed && !listed->table.empty())
        return hash_file(listed->table, hash);
    if (const auto* grids = std::get_if<GridDescription>(&mixture.kind)) {
        for (const auto& field : grids->fields) hash = hash_file(field.file, hash);
    }
    if (const auto* blend = std::get_if<BlendDescription>(&mixture.kind)) {
        for (const MixtureDescription& part : blend->mixtures) hash = hash_files(part, hash);
        for (const MixtureDescription& part : blend->by) hash = hash_files(part, hash);
    }
    return hash;
}

} // namespace

uint64_t hash_mixture(const MixtureDescription& mixture, const std::filesystem::path& folder, uint64_t seed)
{
    const std::string text = write_mixture(mixture, folder).dump();
    return hash_files(mixture, hash_bytes(text.data(), text.size(), seed));
}

} // namespace scree
