#pragma once

#include "base/math.h"
#include "ingest/meshes/triangle_mesh.h"
#include "render/loop/render_job.h"
#include "tests/builders/test_files.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathQuat.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace scree::test {

struct DumpGrain {
    uint64_t id;
    int type;
    V3d center;
    double radius;
    Imath::Quatd orientation{1, 0, 0, 0}; ///< written if SceneFiles::orientations is set
};

/// A scene as a user has it: a scene file, a dump, meshes. All lengths are multiplied by `scale`, and positions then
/// moved by `offset`; values per length are divided by `scale`.
///
/// The standard scene has grains of types 1 to 4 (tinted glass sphere, Lambert sphere, Lambert cube, rough glass
/// icosahedron) on a floor under lights of every finite kind, a sun and a constant sky.
struct SceneFiles {
    double scale = 1;
    V3d offset{0};
    std::vector<std::vector<DumpGrain>> frames; ///< of the dump, rows in this order
    bool orientations = false;
    bool floor = true;
    double aperture = 0.3;
    std::string film =
        R"({"size": [40, 30], "aov": ["albedo", "normal", "depth", "type", "id", "variance", "samples"]})";

    /// Writes all files; returns the scene's name.
    std::string write(const TemporaryFolder& folder) const;
};

/// 40 disordered, slightly overlapping grains of types 1 to 4; coordinates are multiples of 2^-20.
std::vector<DumpGrain> standard_grains();
SceneFiles standard_scene();

/// Text of a LAMMPS dump, numbers with all their digits.
std::string dump_text(const std::vector<std::vector<DumpGrain>>& frames, bool orientations);
std::string obj_text(const TriangleMesh& mesh);

/// An EXR read back, whatever channels it has.
struct Picture {
    std::map<std::string, std::vector<float>> floats;
    std::map<std::string, std::vector<uint32_t>> integers;
    Imath::Box2i data, display;
    std::map<std::string, std::string> texts;
    std::map<std::string, double> numbers;
    std::map<std::string, Imath::M44f> matrices;

    int width() const { return data.max.x - data.min.x + 1; }
    int height() const { return data.max.y - data.min.y + 1; }
    size_t index(int x, int y) const
    {
        return static_cast<size_t>(y - data.min.y) * static_cast<size_t>(width()) + static_cast<size_t>(x - data.min.x);
    }
    double mean(const std::string& channel) const;
    bool all_finite() const;
};

Picture read_picture(const std::filesystem::path& path);

/// Renders a scene file to out.exr beside it, 4 samples a pixel unless `change` says otherwise, and reads that back.
Picture render_picture(const std::string& scene, const std::function<void(RenderJob&)>& change = {});

/// How `part` (a crop, or a picture of the same size) differs from `whole`: "" when every channel has the same bits,
/// with depths multiplied by depth_scale.
std::string difference(const Picture& part, const Picture& whole, float depth_scale = 1);

} // namespace scree::test
