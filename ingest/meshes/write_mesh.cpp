#include "ingest/meshes/write_mesh.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text.h"

#include <fmt/format.h>

#include <bit>
#include <fstream>
#include <iterator>

namespace scree {

namespace {

static_assert(std::endian::native == std::endian::little,
              "the binary formats are copied from memory, in its byte order");

template <class T>
void append(std::string& out, const T& value)
{
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string obj_text(const TriangleMesh& mesh)
{
    std::string out;
    for (const auto& p : mesh.positions) fmt::format_to(std::back_inserter(out), "v {} {} {}\n", p.x, p.y, p.z);
    for (const auto& t : mesh.triangles)
        fmt::format_to(std::back_inserter(out), "f {} {} {}\n", t[0] + uint64_t{1}, t[1] + uint64_t{1},
                       t[2] + uint64_t{1});
    return out;
}

std::string off_text(const TriangleMesh& mesh)
{
    std::string out = fmt::format("OFF\n{} {} 0\n", mesh.positions.size(), mesh.triangles.size());
    for (const auto& p : mesh.positions) fmt::format_to(std::back_inserter(out), "{} {} {}\n", p.x, p.y, p.z);
    for (const auto& t : mesh.triangles) fmt::format_to(std::back_inserter(out), "3 {} {} {}\n", t[0], t[1], t[2]);
    return out;
}

std::string ply_bytes(const TriangleMesh& mesh)
{
    std::string out = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double "
                                  "x\nproperty double y\nproperty double z\n"
                                  "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                                  mesh.positions.size(), mesh.triangles.size());
    for (const auto& p : mesh.positions) {
        for (const double x : {p.x, p.y, p.z}) append(out, x);
    }
    for (const auto& t : mesh.triangles) {
        append(out, uint8_t{3});
        append(out, t);
    }
    return out;
}

std::string stl_bytes(const TriangleMesh& mesh)
{
    std::string out = "Scree";
    out.resize(80, ' ');
    append(out, static_cast<uint32_t>(mesh.triangles.size()));
    for (const auto& t : mesh.triangles) {
        const auto &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
        for (const auto& v : {(b - a).cross(c - a).normalized(), a, b, c}) {
            for (const double x : {v.x, v.y, v.z}) append(out, static_cast<float>(x));
        }
        append(out, uint16_t{0});
    }
    return out;
}

struct Format {
    const char* extension;
    std::string (*content)(const TriangleMesh& mesh);
};
constexpr Format formats[] = {{".obj", obj_text}, {".ply", ply_bytes}, {".stl", stl_bytes}, {".off", off_text}};

const Format& format_of(const std::filesystem::path& path)
{
    const std::string extension = lower_case(path.extension().string());
    for (const Format& format : formats) {
        if (extension == format.extension) return format;
    }
    throw InputError(path.string(), extension.empty() ? "no extension" : "extension " + extension,
                     "a name that ends in .obj, .ply, .stl or .off");
}

} // namespace

void check_mesh_extension(const std::filesystem::path& path) { format_of(path); }

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh)
{
    const Format& format = format_of(path);
    AtomicFile file(path);
    const std::string content = format.content(mesh);
    std::ofstream out(file.temporary(), std::ios::binary);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    out.close();
    if (!out) throw InputError(path.string(), "a disk that is full or cannot be written", "room for the mesh");
    file.commit();
}

} // namespace scree
