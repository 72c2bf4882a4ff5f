#include "render/gsdf/gsdf_file.h"

#include "base/content_hash.h"
#include "base/table_file.h"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

static_assert(sizeof(GsdfRecord) == 16 && sizeof(Imath::C3f) == 12);

constexpr std::array<char, 8> magic{'S', 'C', 'R', 'E', 'E', 'G', 'S', 'D'};
const std::string what = "a table of grain scattering";
constexpr uint32_t version = 3; // of the format and of the numbers' meaning: increase it when either changes

/// The start of a file; alpha0, density, first, records and weights follow, as they lie in memory.
struct Header {
    std::array<char, 8> magic{};
    uint32_t version = 0, alpha_bins = 0, strata = 0, cells = 0;
    uint64_t records = 0, weights = 0;
    uint64_t checksum = 0; // of all that follows the checksum
    GsdfTag tag;
    GsdfQuality quality;
};
static_assert(std::is_trivially_copyable_v<Header>);

/// Calls `each` with the bytes of all parts, in order.
template <class Data, class Each>
void for_each_part(Data& data, const Each& each)
{
    for_each_block(each, data.alpha0, data.density, data.first, data.records, data.weights);
}

uint64_t checksum_of(const Header& header, const Gsdf::Data& data)
{
    uint64_t hash = hash_bytes(&header.tag, sizeof header.tag, version);
    hash = hash_bytes(&header.quality, sizeof header.quality, hash);
    for_each_part(data, [&](const void* bytes, size_t size) { hash = hash_bytes(bytes, size, hash); });
    return hash;
}

} // namespace

void write_gsdf(const std::filesystem::path& file, const Gsdf& gsdf, const GsdfTag& tag)
{
    const Gsdf::Data& data = gsdf.data();
    Header header{magic, version, Gsdf::alpha_bins, Gsdf::strata, Gsdf::cells, data.records.size(), data.weights.size(),
                  0,     tag,     data.quality};
    header.checksum = checksum_of(header, data);
    TableFileWriter writer(file, what);
    writer.add(header);
    for_each_part(data, [&](const void* bytes, size_t size) { writer.add(bytes, size); });
    writer.write();
}

StoredGsdf read_gsdf(const std::filesystem::path& file)
{
    TableFileReader reader(file, what);
    const auto header = reader.read<Header>();
    if (header.magic != magic) throw reader.refuse("a file of another kind");
    if (header.version != version || header.alpha_bins != Gsdf::alpha_bins || header.strata != Gsdf::strata ||
        header.cells != Gsdf::cells) {
        throw reader.refuse("a file of another version");
    }
    constexpr size_t all = static_cast<size_t>(Gsdf::strata) * Gsdf::cells;
    const uint64_t fixed = (Gsdf::alpha_bins + all) * sizeof(float) + (all + 1) * sizeof(uint32_t);
    const bool counts_fit = header.records < (1ull << 32) && (header.weights == 0 || header.weights == header.records);
    if (!counts_fit ||
        reader.left() != fixed + header.records * sizeof(GsdfRecord) + header.weights * sizeof(Imath::C3f))
        throw reader.refuse("a file of the wrong length");

    Gsdf::Data data;
    data.alpha0.resize(Gsdf::alpha_bins);
    data.density.resize(all);
    data.first.resize(all + 1);
    data.records.resize(header.records);
    data.weights.resize(header.weights);
    data.quality = header.quality;
    for_each_part(data, [&](void* bytes, size_t size) { reader.read(bytes, size); });
    reader.finish(checksum_of(header, data), header.checksum);
    if (!std::ranges::is_sorted(data.first) || data.first.front() != 0 || data.first.back() != header.records) {
        throw reader.refuse("a damaged file: its records are not in order");
    }
    for (size_t i = 0; i < all; ++i) {
        if (!(data.density[i] >= 0 && std::isfinite(data.density[i])) ||
            (data.density[i] > 0 && data.first[i] == data.first[i + 1])) {
            throw reader.refuse("a damaged file: a direction without a density or without a record");
        }
    }
    return {std::make_shared<const Gsdf>(std::move(data)), header.tag};
}

} // namespace scree
