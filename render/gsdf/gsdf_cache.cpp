#include "render/gsdf/gsdf_cache.h"

#include "base/content_hash.h"
#include "base/error.h"
#include "render/gsdf/gsdf_file.h"

#include <fmt/format.h>

#include <cstdlib>

namespace scree {

namespace {

std::filesystem::path from_environment(const char* variable)
{
    const char* value = std::getenv(variable);
    return value ? value : "";
}

std::filesystem::path file_of(uint64_t key, const std::filesystem::path& folder)
{
    return folder / fmt::format("gsdf-{:016x}.bin", key);
}

} // namespace

std::filesystem::path cache_folder()
{
    if (const auto folder = from_environment("SCREE_CACHE"); !folder.empty()) return folder;
    if (const auto folder = from_environment("XDG_CACHE_HOME"); !folder.empty()) return folder / "scree";
    if (const auto home = from_environment("HOME"); !home.empty()) return home / ".cache" / "scree";
    return {};
}

uint64_t gsdf_key(const GsdfSource& source, const GsdfOptions& options)
{
    const Material& m = source.material;
    uint64_t key = mix64(source.shape);
    const auto add = [&](const auto& value) { key = hash_bytes(&value, sizeof value, key); };
    add(options.seed);
    add(options.error);
    add(options.most_paths);
    add(m.kind);
    if (m.kind != MaterialKind::lambert) add(m.alpha);
    if (m.kind == MaterialKind::dielectric) add(m.ior);
    if (m.kind == MaterialKind::conductor) {
        add(Imath::C3f(m.eta)); // floats, so that a build in double precision has the same key
        add(Imath::C3f(m.k));
    }
    return key;
}

FoundGsdf stored_gsdf(const GsdfSource& source, const GsdfOptions& options, const std::filesystem::path& folder)
{
    FoundGsdf found;
    if (folder.empty()) return found;
    const uint64_t key = gsdf_key(source, options);
    found.file = file_of(key, folder);
    std::error_code none;
    if (!std::filesystem::exists(found.file, none)) return found;
    try {
        StoredGsdf stored = read_gsdf(found.file);
        if (stored.tag.key == key)
            found.gsdf = std::move(stored.gsdf);
        else
            found.remark = fmt::format("{} belongs to another grain; it is made again", found.file.string());
    } catch (const InputError& error) {
        found.remark = fmt::format("{}: {}; it is made again", error.place(), error.found());
    }
    return found;
}

FoundGsdf find_gsdf(const GsdfSource& source, const GsdfOptions& options, const std::filesystem::path& folder,
                    const Progress& progress)
{
    FoundGsdf stored = stored_gsdf(source, options, folder);
    if (stored.gsdf) return stored;
    FoundGsdf made = make_gsdf(source, options, folder, progress);
    if (made.remark.empty()) made.remark = stored.remark;
    return made;
}

FoundGsdf make_gsdf(const GsdfSource& source, const GsdfOptions& options, const std::filesystem::path& folder,
                    const Progress& progress)
{
    const std::shared_ptr<const Exemplar> exemplar = source.exemplar ? source.exemplar() : nullptr;
    FoundGsdf found;
    found.gsdf = build_gsdf({exemplar.get(), source.material}, options, progress);
    found.computed = true;
    if (folder.empty()) return found;
    const uint64_t key = gsdf_key(source, options);
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
