#include "render/grains/shape_source.h"

#include "base/content_hash.h"
#include "base/error.h"

#include <fstream>

namespace scree {

namespace {

uint64_t hash_file(const std::filesystem::path& path)
{
    std::error_code none;
    const uint64_t size = std::filesystem::is_regular_file(path, none) ? std::filesystem::file_size(path, none) : 0;
    std::vector<char> bytes(none ? 0 : size);
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!file || bytes.empty()) read_mesh(path); // throws the right error
    return hash_bytes(bytes.data(), bytes.size(), 1);
}

} // namespace

uint64_t hash_shape(const ShapeSource& source)
{
    return source.mesh ? hash_file(*source.mesh) : source.has_mesh() ? hash_shape(*source.library, source.options) : 0;
}

std::shared_ptr<const Exemplar> make_exemplar(const EmbreeDevice& device, const ShapeSource& source,
                                              const Material& material, const std::string& place,
                                              const std::string& name)
{
    const std::string where = source.mesh ? source.mesh->string() : place;
    const TriangleMesh mesh =
        source.mesh ? read_mesh(*source.mesh) : make_grain_shape(*source.library, source.options, where);
    auto exemplar = std::make_shared<Exemplar>(device, mesh, where);
    if (material.transmits() && !exemplar->closed()) {
        throw InputError(where, "an open or inconsistently oriented mesh",
                         "a closed mesh, as the material of '" + name + "' is a dielectric",
                         "close it, or give the type an opaque material");
    }
    return exemplar;
}

} // namespace scree
