// The statue and the cloud of the benchmark suite: make_bench FOLDER writes statue.off and cloud.vdb there.

#include "tests/builders/statue.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace {

/// Noise by sums of waves: smooth, the same everywhere.
double billows(const openvdb::Vec3d& p)
{
    double sum = 0, weight = 0.5, scale = 3;
    for (int octave = 0; octave < 4; ++octave) {
        const openvdb::Vec3d q = scale * p;
        sum += weight * std::sin(q.x() + 1.7 * std::sin(q.y() + octave)) *
               std::sin(q.y() + 1.3 * std::sin(q.z() + 2 * octave)) *
               std::sin(q.z() + 1.1 * std::sin(q.x() + 3 * octave));
        weight *= 0.5;
        scale *= 2.03;
    }
    return sum;
}

/// Density 0 to 1 of a cloud some 2 wide and 1 high around the origin.
double cloud(const openvdb::Vec3d& p)
{
    double nearest = 1e9;
    constexpr double puffs[][4] = {{0, 0, 0, 0.45},         {0.45, 0.1, -0.05, 0.35},  {-0.45, -0.1, -0.1, 0.33},
                                   {0.1, -0.15, 0.25, 0.3}, {-0.75, 0.05, -0.15, 0.2}, {0.8, 0, -0.15, 0.2}};
    for (const auto& c : puffs) nearest = std::min(nearest, (p - openvdb::Vec3d(c[0], c[1], c[2])).length() - c[3]);
    return std::clamp(-6 * (nearest + 0.28 * billows(2 * p)), 0.0, 1.0);
}

void write_statue(const std::string& path)
{
    const scree::TriangleMesh mesh = scree::statue_mesh(90);
    std::FILE* out = std::fopen(path.c_str(), "w");
    if (!out) throw std::runtime_error(path + " cannot be written");
    std::fprintf(out, "OFF\n%zu %zu 0\n", mesh.positions.size(), mesh.triangles.size());
    for (const auto& p : mesh.positions) std::fprintf(out, "%.6g %.6g %.6g\n", p.x, p.y, p.z);
    for (const auto& t : mesh.triangles) std::fprintf(out, "3 %u %u %u\n", t[0], t[1], t[2]);
    if (std::fclose(out) != 0) throw std::runtime_error(path + " cannot be written");
}

void write_cloud(const std::string& path)
{
    openvdb::initialize();
    constexpr double voxel = 0.025;
    auto grid = openvdb::FloatGrid::create(0);
    grid->setName("density");
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    auto accessor = grid->getAccessor();
    for (int z = -30; z <= 30; ++z)
        for (int y = -30; y <= 30; ++y)
            for (int x = -50; x <= 50; ++x) {
                const double density = cloud(voxel * openvdb::Vec3d(x, y, z));
                if (density > 0) accessor.setValue({x, y, z}, static_cast<float>(density));
            }
    openvdb::tools::prune(grid->tree());
    grid->setSaveFloatAsHalf(true);
    openvdb::io::File file(path);
    file.write({grid});
    file.close();
}

} // namespace

int main(int argc, char** argv)
try {
    if (argc < 2) return std::fprintf(stderr, "usage: make_bench FOLDER\n"), 2;
    write_statue(std::string(argv[1]) + "/statue.off");
    write_cloud(std::string(argv[1]) + "/cloud.vdb");
    return 0;
} catch (const std::exception& error) {
    return std::fprintf(stderr, "make_bench: %s\n", error.what()), 1;
}
