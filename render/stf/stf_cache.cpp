#include "render/stf/stf_cache.h"

#include "base/content_hash.h"
#include "base/error.h"
#include "render/stf/stf_file.h"

#include <fmt/format.h>

namespace scree {

uint64_t StfCache::key(double g, const PhaseTable* table) const
{
    uint64_t key = mix64(Stf::steps_per_octave);
    const auto add = [&](const auto& value) { key = hash_bytes(&value, sizeof value, key); };
    add(options_.walks);
    add(options_.records);
    add(options_.seed);
    if (table)
        add(table->table().density);
    else
        add(g);
    return key;
}

std::filesystem::path StfCache::file(uint64_t key) const { return folder_ / fmt::format("stf-{:016x}.bin", key); }

StfCache::Found StfCache::find(double g, const std::shared_ptr<const PhaseTable>& table, size_t shells,
                               const Progress& progress)
{
    const uint64_t k = key(g, table.get());
    Found found;
    std::shared_ptr<const Stf>& known = known_[k];
    std::error_code none;
    if (!known && !folder_.empty() && std::filesystem::exists(file(k), none)) {
        try {
            auto stored = std::make_shared<Stf>(table ? Stf(table) : Stf(g));
            read_stf(file(k), k, *stored);
            known = std::move(stored);
        } catch (const InputError& error) {
            found.remark = fmt::format("{}: {}; it is made again", error.place(), error.found());
        }
    }
    if (!known || known->shells.size() < shells) {
        auto made = known ? std::make_shared<Stf>(*known) : std::make_shared<Stf>(table ? Stf(table) : Stf(g));
        found.computed = shells - made->shells.size();
        found.seconds = extend_stf(*made, shells, options_, progress);
        known = made;
        if (!folder_.empty()) {
            try {
                std::filesystem::create_directories(folder_, none);
                write_stf(file(k), *known, k);
            } catch (const InputError& error) {
                found.remark = fmt::format("shell transport functions are not kept for the next run: {}", error.what());
            }
        }
    }
    found.stf = known;
    return found;
}

} // namespace scree
