#include "tests/ingest/mesh_files.h"

#include <array>
#include <cctype>

namespace scree::test {

namespace {

std::string vertex_lines(const char* keyword)
{
    std::string text;
    for (const V3d& p : box_corners) text += fmt::format("{}{} {} {}\n", keyword, p.x, p.y, p.z);
    return text;
}

} // namespace

std::string box_obj(const std::function<std::string(uint32_t)>& corner)
{
    std::string text =
        "# a box\nmtllib box.mtl\no box\n" + vertex_lines("v ") + "vt 0 0\nvn 0 0 1\nusemtl stone\ns off\ng sides\n";
    for (const auto& face : box_faces) {
        text += "f";
        for (const uint32_t vertex : face) text += fmt::format(" {}", corner(vertex));
        text += "\n";
    }
    return text;
}

std::string box_off()
{
    std::string text = "OFF\n# a box\n8 6 12\n" + vertex_lines("");
    for (const auto& [a, b, c, d] : box_faces) text += fmt::format("4  {} {} {} {}  0.5 0.5 0.5\n", a, b, c, d);
    return text;
}

std::string box_off_binary()
{
    constexpr auto big = std::endian::big;
    std::string content = "OFF BINARY\n" + bytes(8, big) + bytes(6, big) + bytes(12, big);
    for (const V3d& p : box_corners) {
        for (int axis = 0; axis < 3; ++axis) content += bytes(static_cast<float>(p[axis]), big);
    }
    for (const auto& face : box_faces) {
        content += bytes(4, big);
        for (const uint32_t vertex : face) content += bytes(static_cast<int32_t>(vertex), big);
        content += bytes(3, big) + bytes(0.5f, big) + bytes(0.5f, big) + bytes(0.5f, big);
    }
    return content;
}

std::string box_ply_header(const char* format, const char* index_type)
{
    return fmt::format(
        "ply\nformat {} 1.0\ncomment a box\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z\n"
        "property uchar red\nelement face 6\nproperty list uchar {} vertex_indices\nend_header\n",
        format, index_type);
}

std::string box_ply()
{
    std::string text = box_ply_header("ascii", "int");
    for (const V3d& p : box_corners) text += fmt::format("{} {} {} 255\n", p.x, p.y, p.z);
    for (const auto& [a, b, c, d] : box_faces) text += fmt::format("4 {} {} {} {}\n", a, b, c, d);
    return text;
}

std::string box_stl(bool upper)
{
    std::string text = "solid a box\n";
    for (const auto& face : box_faces) {
        for (const auto& corners : {std::array{face[0], face[1], face[2]}, std::array{face[0], face[2], face[3]}}) {
            text += " facet normal 0 0 0\n  outer loop\n";
            for (const uint32_t c : corners) {
                text += fmt::format("   vertex {} {} {}\n", box_corners[c].x, box_corners[c].y, box_corners[c].z);
            }
            text += "  endloop\n endfacet\n";
        }
    }
    text += "endsolid a box\n";
    if (upper) std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

std::string box_stl_binary(const std::string& title)
{
    constexpr auto little = std::endian::little;
    std::string content = title;
    content.resize(80);
    content += bytes(uint32_t{12}, little);
    for (const auto& face : box_faces) {
        for (const auto& corners : {std::array{face[0], face[1], face[2]}, std::array{face[0], face[2], face[3]}}) {
            for (int axis = 0; axis < 3; ++axis) content += bytes(0.0f, little);
            for (const uint32_t c : corners) {
                for (int axis = 0; axis < 3; ++axis) content += bytes(static_cast<float>(box_corners[c][axis]), little);
            }
            content += bytes(uint16_t{0}, little);
        }
    }
    return content;
}

} // namespace scree::test
