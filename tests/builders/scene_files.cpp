#include "tests/builders/scene_files.h"

#include "tests/builders/packings.h"
#include "tests/builders/shapes.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <cstring>
#include <stdexcept>

namespace scree::test {

std::vector<DumpGrain> standard_grains()
{
    std::vector<DumpGrain> grains;
    const auto spheres = push_apart(40, 0.45, 0.5, 0.05, 3);
    for (size_t i = 0; i < spheres.size(); ++i) {
        V3d c = spheres[i].center;
        for (int a = 0; a < 3; ++a) c[a] = std::round(c[a] * 0x1p20) * 0x1p-20;
        grains.push_back({i + 1, static_cast<int>(i % 4) + 1, c, static_cast<float>(spheres[i].radius)});
    }
    return grains;
}

SceneFiles standard_scene()
{
    SceneFiles files;
    files.frames = {standard_grains()};
    return files;
}

std::string dump_text(const std::vector<std::vector<DumpGrain>>& frames, bool orientations)
{
    std::string text;
    for (size_t f = 0; f < frames.size(); ++f) {
        V3d lo(0), hi(0);
        for (const DumpGrain& g : frames[f]) {
            for (int a = 0; a < 3; ++a) {
                lo[a] = std::min(lo[a], g.center[a] - 2 * g.radius);
                hi[a] = std::max(hi[a], g.center[a] + 2 * g.radius);
            }
        }
        text += fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff ff\n", 100 * f,
                            frames[f].size());
        for (int a = 0; a < 3; ++a) text += fmt::format("{:.17g} {:.17g}\n", lo[a], hi[a]);
        text += fmt::format("ITEM: ATOMS id type x y z radius{}\n", orientations ? " quatw quati quatj quatk" : "");
        for (const DumpGrain& g : frames[f]) {
            text += fmt::format("{} {} {:.17g} {:.17g} {:.17g} {:.17g}", g.id, g.type, g.center.x, g.center.y,
                                g.center.z, g.radius);
            const Imath::Quatd& q = g.orientation;
            if (orientations) text += fmt::format(" {:.17g} {:.17g} {:.17g} {:.17g}", q.r, q.v.x, q.v.y, q.v.z);
            text += "\n";
        }
    }
    return text;
}

std::string obj_text(const TriangleMesh& mesh)
{
    std::string text;
    for (const V3d& p : mesh.positions) text += fmt::format("v {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
    for (const auto& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    return text;
}

std::string SceneFiles::write(const TemporaryFolder& folder) const
{
    const auto point = [&](double x, double y, double z) {
        const V3d p = V3d(x, y, z) * scale + offset;
        return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", p.x, p.y, p.z);
    };
    const auto vector = [&](double x, double y, double z) {
        return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x * scale, y * scale, z * scale);
    };
    const auto length = [&](double x) { return fmt::format("{:.17g}", x * scale); };
    const auto rgb_per_length = [&](double r, double g, double b) {
        return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", r / scale, g / scale, b / scale);
    };

    auto moved = frames;
    for (auto& frame : moved) {
        for (DumpGrain& g : frame) {
            g.center = g.center * scale + offset;
            g.radius *= scale;
        }
    }
    folder.write("grains.dump", dump_text(moved, orientations));
    folder.write("cube.obj", obj_text(cube()));
    folder.write("ball.obj", obj_text(icosphere(1)));
    TriangleMesh plane = ground(16, -5);
    for (V3d& p : plane.positions) p = p * scale + offset;
    folder.write("floor.obj", obj_text(plane));

    std::string text = "// Written by a test.\n{\n";
    text += fmt::format(R"("camera": {{"origin": {}, "target": {}, "fov": 40, "aperture": {}, "focus": {}}},)",
                        point(-9, -11, 7), point(0, 0, -1), length(aperture), length(14)) +
            "\n";
    text += "\"film\": " + film + ",\n";
    text += fmt::format(R"("lights": [{{"kind": "constant", "radiance": [0.3, 0.35, 0.4]}},
  {{"kind": "distant", "direction": [0.3, 0.4, -1], "irradiance": 1.5, "angle": 4}},
  {{"kind": "rectangle", "corner": {}, "edges": [{}, {}], "radiance": [5, 4, 3]}},
  {{"kind": "sphere", "center": {}, "radius": {}, "radiance": 7}}],)",
                        point(-3, -8, 9), vector(4, 0, 0), vector(0, 3, 1), point(6, -5, 4), length(0.75)) +
            "\n";
    if (floor)
        text +=
            R"("surfaces": [{"mesh": "floor.obj", "material": {"kind": "lambert", "reflectance": [0.6, 0.5, 0.4]}}],)"
            "\n";
    text += fmt::format(R"("grains": {{"types": {{
    "glass": {{"shape": "sphere", "material": {{"kind": "dielectric", "ior": 1.5, "absorption": {}}}}},
    "clay": {{"shape": "sphere", "material": {{"kind": "lambert", "reflectance": [0.8, 0.5, 0.3]}}}},
    "cube": {{"shape": {{"mesh": "cube.obj"}}, "material": {{"kind": "lambert", "reflectance": 0.7}}}},
    "gem": {{"shape": {{"mesh": "ball.obj"}}, "material": {{"kind": "dielectric", "ior": 1.4, "roughness": 0.3, "absorption": {}}}}}}},
  "assembly": {{"dump": "grains.dump", "types": {{"1": "glass", "2": "clay", "3": "cube", "4": "gem"}}}}}}
}}
)",
                        rgb_per_length(0.25, 0.5, 0.125), rgb_per_length(0.125, 0.25, 0.5));
    return folder.write("scene.json", text);
}

double Picture::mean(const std::string& channel) const
{
    double sum = 0;
    for (const float x : floats.at(channel)) sum += x;
    return sum / static_cast<double>(floats.at(channel).size());
}

bool Picture::all_finite() const
{
    for (const auto& channel : floats) {
        for (const float x : channel.second) {
            if (!std::isfinite(x)) return false;
        }
    }
    return true;
}

Picture read_picture(const std::filesystem::path& path)
{
    Imf::InputFile file(path.c_str());
    const Imf::Header& header = file.header();
    Picture picture;
    picture.data = header.dataWindow();
    picture.display = header.displayWindow();
    const size_t pixels = static_cast<size_t>(picture.width()) * static_cast<size_t>(picture.height());
    Imf::FrameBuffer buffer;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        char* memory;
        if (it.channel().type == Imf::FLOAT) {
            memory = reinterpret_cast<char*>(picture.floats.try_emplace(it.name(), pixels).first->second.data());
        } else if (it.channel().type == Imf::UINT) {
            memory = reinterpret_cast<char*>(picture.integers.try_emplace(it.name(), pixels).first->second.data());
        } else {
            throw std::runtime_error(std::string("a channel of half floats: ") + it.name());
        }
        const std::ptrdiff_t row = 4 * static_cast<std::ptrdiff_t>(picture.width());
        buffer.insert(it.name(),
                      Imf::Slice(it.channel().type, memory - picture.data.min.x * 4 - picture.data.min.y * row, 4,
                                 static_cast<size_t>(row)));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(picture.data.min.y, picture.data.max.y);
    for (auto it = header.begin(); it != header.end(); ++it) {
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute()))
            picture.texts[it.name()] = text->value();
        if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&it.attribute()))
            picture.numbers[it.name()] = number->value();
        if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&it.attribute()))
            picture.matrices[it.name()] = matrix->value();
    }
    return picture;
}

Picture render_picture(const std::string& scene, const std::function<void(RenderJob&)>& change)
{
    RenderJob job;
    job.scene = scene;
    job.outputs = {(job.scene.parent_path() / "out.exr").string()};
    job.spp = 4;
    job.quiet = true;
    if (change) change(job);
    if (run_render_job(job) != 0) throw std::runtime_error("the render was interrupted");
    return read_picture(job.outputs[0]);
}

std::string difference(const Picture& part, const Picture& whole, float depth_scale)
{
    size_t differing = 0;
    std::string first;
    const auto compare = [&](const std::string& name, const auto& a, const auto& b) {
        for (int y = part.data.min.y; y <= part.data.max.y; ++y) {
            for (int x = part.data.min.x; x <= part.data.max.x; ++x) {
                const auto value = a[part.index(x, y)];
                auto expected = b[whole.index(x, y)];
                if (name == "Z") expected = static_cast<decltype(expected)>(static_cast<float>(expected) * depth_scale);
                if (std::memcmp(&value, &expected, sizeof value) == 0) continue;
                if (differing++ == 0) first = fmt::format("{} at {},{} is {} and not {}", name, x, y, value, expected);
            }
        }
    };
    if (part.floats.size() != whole.floats.size() || part.integers.size() != whole.integers.size())
        return "other channels";
    for (const auto& [name, plane] : part.floats) compare(name, plane, whole.floats.at(name));
    for (const auto& [name, plane] : part.integers) compare(name, plane, whole.integers.at(name));
    if (differing == 0) return "";
    return fmt::format("{} of {} values differ, the first: {}", differing,
                       static_cast<size_t>(part.width()) * static_cast<size_t>(part.height()) *
                           (part.floats.size() + part.integers.size()),
                       first);
}

} // namespace scree::test
