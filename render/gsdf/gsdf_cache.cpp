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
    const uint64_t key = gsdf_key(source, options.seed);
    const std::filesystem::path file = folder.empty() ? folder : file_of(key, folder);
    std::string remark;
    std::error_code none;
    if (!folder.empty() && std::filesystem::exists(file, none)) {
        try {
            StoredGsdf stored = read_gsdf(file);
            if (stored.tag.key != key) {
                remark = fmt::format("{} was of another grain and is made again", file.string());
            } else if (stored.gsdf->data().quality.density_error <= options.error || stored.tag.error <= options.error) {
                return {std::move(stored.gsdf), false, "", file};
            }
        } catch (const InputError& error) {
            remark = fmt::format("{}: {}; it is made again", error.place(), error.found());
        }
    }
    FoundGsdf found = make_gsdf(source, options, folder, progress);
    if (found.remark.empty()) found.remark = remark;
    return found;
}

FoundGsdf make_gsdf(const GsdfSource& source, const GsdfOptions& options, const std::filesystem::path& folder, const Progress& progress)
{
    const std::shared_ptr<const Exemplar> exemplar = source.exemplar ? source.exemplar() : nullptr;
    FoundGsdf found;
    found.gsdf = build_gsdf({exemplar.get(), source.material}, options, progress);
    found.computed = true;
    if (folder.empty()) return found;
    const uint64_t key = gsdf_key(source, options.seed);
    try {
        std::error_code none;
        std::filesystem::create_directories(folder, none);
        write_gsdf(file_of(key, folder), *found.gsdf, {key, options.error});
        found.file = file_of(key, folder);
    } catch (const InputError& error) {
        found.remark = fmt::format("the scattering of grains is not kept for the next run: {}", error.what());
    }
    return found;
}

} // namespace scree
