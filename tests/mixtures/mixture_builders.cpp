#include "tests/mixtures/mixture_builders.h"

#include "base/hash.h"
#include "base/json.h"
#include "mixtures/read_mixture.h"

#include <openvdb/openvdb.h>

#include <cmath>
#include <numbers>

namespace scree::test {

uint64_t Numbers::bits() { return hash_index(count_++, seed_, 0x74657374); }
double Numbers::unit() { return unit_double(bits()); }

ParticleFrame random_spheres(size_t count, double edge, double sigma, Imath::V3d center, uint64_t seed)
{
    Numbers numbers(seed);
    ParticleFrame frame;
    frame.has_ids = true;
    frame.origin = center;
    for (size_t i = 0; i < count; ++i) {
        Imath::V3d p;
        for (int a = 0; a < 3; ++a) p[a] = center[a] + edge * (numbers.unit() - 0.5);
        frame.position.push_back(p);
        const double normal =
            std::sqrt(-2 * std::log(1 - numbers.unit())) * std::cos(2 * std::numbers::pi * numbers.unit());
        frame.radius.push_back(static_cast<float>(std::exp(sigma * normal)));
        frame.type.push_back(static_cast<int32_t>(1 + i % 3));
        frame.id.push_back(i + 1);
    }
    return frame;
}

std::unique_ptr<Mixture> mixture_of(const std::string& json, const ParticleFrame* frame,
                                    const std::filesystem::path& folder)
{
    const JsonDocument document = JsonDocument::parse(json, "test", folder);
    const MixtureContext context{{"a", "b", "c", "d"}, {{1, "a"}, {2, "b"}, {3, "c"}}, frame, false, "dump"};
    return make_mixture(read_mixture(document.root(), context.types), context);
}

std::vector<uint32_t> types_of(const Mixture& mixture, const ParticleFrame& frame)
{
    std::vector<uint32_t> types(frame.size());
    for (size_t i = 0; i < types.size(); ++i) types[i] = mixture.type(i, frame.relative_position(i));
    return types;
}

void write_ramp(const std::filesystem::path& path, int edge)
{
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(0);
    grid->setName("c");
    for (int x = 0; x < edge; ++x)
        for (int y = 0; y < edge; ++y)
            for (int z = 0; z < edge; ++z)
                grid->tree().setValue({x, y, z}, static_cast<float>(x) / static_cast<float>(edge - 1));
    openvdb::io::File(path.string()).write(openvdb::GridCPtrVec{grid});
}

} // namespace scree::test
