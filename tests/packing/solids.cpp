#include "tests/packing/solids.h"

#include "tests/builders/shapes.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Composite.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <cmath>
#include <numbers>

namespace scree {

using Imath::V3d;

TriangleMesh torus(double major, double minor, int around, int along)
{
    TriangleMesh mesh;
    for (int i = 0; i < around; ++i) {
        const double phi = 2 * std::numbers::pi * i / around;
        for (int j = 0; j < along; ++j) {
            const double theta = 2 * std::numbers::pi * j / along, r = major + minor * std::cos(theta);
            mesh.positions.emplace_back(r * std::cos(phi), r * std::sin(phi), minor * std::sin(theta));
        }
    }
    const auto vertex = [&](int i, int j) { return static_cast<uint32_t>((i % around) * along + j % along); };
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < along; ++j) {
            const uint32_t a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    }
    return mesh;
}

TriangleMesh double_walled_shell(int level, double thickness)
{
    const TriangleMesh sphere = icosphere(level);
    return joined(sphere, flipped(scaled(sphere, 1 - thickness)));
}

TriangleMesh bored_cube(int cells)
{
    openvdb::initialize();
    const double voxel = 2.0 / cells;
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
    auto grid = openvdb::FloatGrid::create(static_cast<float>(4 * voxel));
    grid->setTransform(transform);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    // The maximum of signed distances is close enough, near the surface, to the distance of the intersection.
    const auto value = [](const V3d& p) {
        const double cube = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) - 1;
        const double bores =
            std::max({0.45 - std::hypot(p.x, p.y), 0.45 - std::hypot(p.y, p.z), 0.45 - std::hypot(p.z, p.x)});
        const double corner = 0.5 - (V3d(std::abs(p.x), std::abs(p.y), std::abs(p.z)) - V3d(1)).length();
        return std::max({cube, bores, corner});
    };
    auto accessor = grid->getAccessor();
    const int reach = cells / 2 + 5;
    for (int i = -reach; i <= reach; ++i)
        for (int j = -reach; j <= reach; ++j)
            for (int k = -reach; k <= reach; ++k) {
                // Half a voxel aside, so that no face of the cube runs through centres of voxels.
                const double d = value(V3d(i + 0.5, j + 0.5, k + 0.5) * voxel);
                if (std::abs(d) < 4 * voxel) accessor.setValue({i, j, k}, static_cast<float>(d));
            }
    openvdb::tools::signedFloodFill(grid->tree());
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*grid, points, quads);
    TriangleMesh mesh;
    for (const auto& p : points) mesh.positions.emplace_back(p.x(), p.y(), p.z());
    // OpenVDB's polygons are clockwise when seen from outside.
    for (const auto& q : quads) {
        mesh.triangles.push_back({q[2], q[1], q[0]});
        mesh.triangles.push_back({q[3], q[2], q[0]});
    }
    return mesh;
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b)
{
    TriangleMesh mesh = a;
    const auto offset = static_cast<uint32_t>(a.positions.size());
    mesh.positions.insert(mesh.positions.end(), b.positions.begin(), b.positions.end());
    for (const auto& t : b.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    return mesh;
}

TriangleMesh flipped(TriangleMesh mesh)
{
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, double factor)
{
    for (V3d& p : mesh.positions) p *= factor;
    return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const V3d& by)
{
    for (V3d& p : mesh.positions) p += by;
    return mesh;
}

} // namespace scree
