#include "render/gsdf/gsdf_cache.h"

#include "ingest/support/error.h"
#include "render/gsdf/gsdf_file.h"
#include "render/scene/content_hash.h"

#include <fmt/format.h>

#include <cstdlib>

namespace scree {

namespace {

std::filesystem::path from_environment(const char* variable)
{
    const char* value = std::getenv(variable);
    return value ? value : "";
}

std::filesystem::path file_of(uint64_t key, const std::filesystem::path& folder) { return folder / fmt::format("gsdf-{:016x}.bin", key); }

} // namespace

std::filesystem::path cache_folder()
{
    if (const auto folder = from_environment("SCREE_CACHE"); !folder.empty()) return folder;
    if (const auto folder = from_environment("XDG_CACHE_HOME"); !folder.empty()) return folder / "scree";
    if (const auto home = from_environment("HOME"); !home.empty()) return home / ".cache" / "scree";
    return {};
}

uint64_t gsdf_key(const GsdfSource& source, uint64_t seed)
{
    const Material& m = source.material;
    uint64_t key = mix64(mix64(source.shape) ^ seed);
    const auto add = [&](const auto& value) { key = hash_bytes(&value, sizeof value, key); };
    add(m.kind);
    if (m.kind != MaterialKind::lambert) add(m.alpha);
    if (m.kind == MaterialKind::dielectric) add(m.ior);
    if (m.kind == MaterialKind::conductor) {
        add(m.eta);
        add(m.k);
    }
    return key;
}

bool is_gsdf_stored(const GsdfSource& source, const GsdfOptions& options, const std::filesystem::path& folder)
{
    std::error_code none;
    return !folder.empty() && std::filesystem::exists(file_of(gsdf_key(source, options.seed), folder), none);
}

FoundGsdf find_gsdf(const GsdfSource& source, const GsdfOptions& options, const std::filesystem::path& folder, const Progress& progress)
{
    FoundGsdf found;
    const uint64_t key = gsdf_key(source, options.seed);
    if (!folder.empty()) {
        found.file = file_of(key, folder);
        std::error_code none;
        if (std::filesystem::exists(found.file, none)) {
            try {
                StoredGsdf stored = read_gsdf(found.file);
                if (stored.tag.key != key) {
                    found.remark = fmt::format("{} was of another grain and is made again", found.file.string());
                } else if (stored.gsdf->data().quality.density_error <= options.error || stored.tag.error <= options.error) {
                    found.gsdf = std::move(stored.gsdf);
                    return found;
                }
            } catch (const InputError& error) {
                found.remark = fmt::format("{}: {}; it is made again", error.place(), error.found());
            }
        }
    }
    const std::shared_ptr<const Exemplar> exemplar = source.exemplar ? source.exemplar() : nullptr;
    found.gsdf = build_gsdf({exemplar.get(), source.material}, options, progress);
    found.computed = true;
    if (folder.empty()) return found;
    try {
        std::error_code none;
        std::filesystem::create_directories(folder, none);
        write_gsdf(found.file, *found.gsdf, {key, options.error});
    } catch (const InputError& error) {
        found.remark = fmt::format("the scattering of grains is not kept for the next run: {}", error.what());
        found.file.clear();
    }
    return found;
}

} // namespace scree
