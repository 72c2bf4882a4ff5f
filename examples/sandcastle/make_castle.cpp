// Makes the mesh of a sandcastle from a level set: make_castle OUT.off [VOXEL]
//
// Lengths in metres, z up, the ground at z = 0. The castle stands on a mound: walls with battlements, a tower at each
// corner, a keep and a gate. The solid is given by a signed distance (near the surface); unions and cuts combine
// distances by min and max.

#include <openvdb/openvdb.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

using openvdb::Vec3d;

double box(const Vec3d& p, const Vec3d& lo, const Vec3d& hi)
{
    const Vec3d q(std::max(lo.x() - p.x(), p.x() - hi.x()), std::max(lo.y() - p.y(), p.y() - hi.y()),
                  std::max(lo.z() - p.z(), p.z() - hi.z()));
    const Vec3d out(std::max(q.x(), 0.0), std::max(q.y(), 0.0), std::max(q.z(), 0.0));
    return out.length() + std::min(0.0, std::max({q.x(), q.y(), q.z()}));
}

/// A frustum of a cone around the z axis through (x, y), radius r0 at z0 and r1 at z1.
double frustum(const Vec3d& p, double x, double y, double z0, double z1, double r0, double r1)
{
    const double d = std::hypot(p.x() - x, p.y() - y), slope = (r1 - r0) / (z1 - z0);
    const double side = (d - (r0 + slope * (p.z() - z0))) / std::hypot(1, slope);
    return std::max({side, z0 - p.z(), p.z() - z1});
}

/// Gaps that repeat around an axis: battlements are what is left between them.
double gaps_around(const Vec3d& p, double x, double y, double z0, int count)
{
    const double pi = 3.14159265358979;
    const double turn = std::atan2(p.y() - y, p.x() - x) * count / (2 * pi), d = std::hypot(p.x() - x, p.y() - y);
    const double off = std::abs(turn - std::round(turn)) * 2 * pi / count * d;
    return std::max(off - 0.25 * 2 * pi / count * d, z0 - p.z());
}

double gaps_along(double u, double z, double z0, double period)
{
    const double off = std::abs(u / period - std::round(u / period)) * period;
    return std::max(off - 0.25 * period, z0 - z);
}

double tower(const Vec3d& p, double x, double y, double radius, double top)
{
    double d = frustum(p, x, y, -0.02, top, 1.12 * radius, 0.95 * radius);
    d = std::min(d, frustum(p, x, y, top - 0.035, top + 0.045, radius, 1.12 * radius)); // the wider crown
    d = std::max(d, -frustum(p, x, y, top + 0.01, top + 0.2, 0.78 * radius, 0.8 * radius)); // hollow above
    return std::max(d, -gaps_around(p, x, y, top + 0.022, 8));
}

double castle(const Vec3d& p)
{
    const double a = 0.27, wall = 0.045, top = 0.20;
    // A low mound that flattens out to the ground.
    const double d0 = std::hypot(p.x(), p.y());
    double mound = (p.z() - 0.055 * std::exp(-std::pow(d0 / 0.46, 6)) - 0.03 * (1 - d0 * d0 / 0.36)) * 0.8;
    mound = std::max({mound, -p.z(), d0 - 0.60});

    double walls = std::max(box(p, {-a - wall, -a - wall, 0.0}, {a + wall, a + wall, top}),
                            -box(p, {-a + wall, -a + wall, -1}, {a - wall, a - wall, 1}));
    // The walk behind the parapet is lower, and the parapet has gaps.
    const double outside = std::max(std::abs(p.x()), std::abs(p.y()));
    walls = std::max(walls, -std::max(std::max(outside - a - 0.018, -(outside - a + wall)), 0.172 - p.z()));
    walls = std::max(walls, -gaps_along(std::abs(p.x()) > std::abs(p.y()) ? p.y() : p.x(), p.z(), 0.172, 0.06));

    double d = std::min(mound, walls);
    for (const double sx : {-1.0, 1.0})
        for (const double sy : {-1.0, 1.0}) d = std::min(d, tower(p, sx * a, sy * a, 0.095, 0.30));
    d = std::min(d, tower(p, 0.02, 0.05, 0.15, 0.36));
    d = std::min(d, tower(p, 0.02, 0.05, 0.085, 0.50));
    // The gate and two windows of the keep.
    const double arch = std::max(0.085 - p.z(), std::hypot(p.x(), std::max(0.0, p.z() - 0.10)) - 0.045);
    d = std::max(d, -std::max({arch, p.y() + a - 0.1, -0.5 - p.y()}));
    for (const double x : {-0.05, 0.09}) d = std::max(d, -box(p, {x - 0.014, -0.2, 0.22}, {x + 0.014, -0.06, 0.27}));
    d = std::max(d, -box(p, {0.006, -0.2, 0.40}, {0.034, 0.0, 0.45}));
    return std::max(d, -p.z());
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 2) return std::fprintf(stderr, "usage: make_castle OUT.off [VOXEL]\n"), 2;
    const double voxel = argc > 2 ? std::atof(argv[2]) : 0.008;
    openvdb::initialize();
    const float band = static_cast<float>(3 * voxel);
    auto grid = openvdb::FloatGrid::create(band);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    auto accessor = grid->getAccessor();
    const int side = static_cast<int>(0.65 / voxel), height = static_cast<int>(0.62 / voxel);
    for (int z = -4; z <= height; ++z)
        for (int y = -side; y <= side; ++y)
            for (int x = -side; x <= side; ++x) {
                // The samples are about half a voxel off the planes of the shape.
                const Vec3d p = voxel * Vec3d(x + 0.37, y + 0.41, z + 0.43);
                const double d = castle(p);
                if (std::abs(d) < band) accessor.setValue({x, y, z}, static_cast<float>(d));
            }
    openvdb::tools::signedFloodFill(grid->tree());

    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*grid, points, triangles, quads, 0.0, 0.0);
    std::FILE* out = std::fopen(argv[1], "w");
    if (!out) return std::perror(argv[1]), 1;
    std::fprintf(out, "OFF\n%zu %zu 0\n", points.size(), triangles.size() + 2 * quads.size());
    for (const auto& p : points) std::fprintf(out, "%.7g %.7g %.7g\n", p.x(), p.y(), p.z());
    // OpenVDB's faces look inwards.
    for (const auto& t : triangles) std::fprintf(out, "3 %u %u %u\n", t[2], t[1], t[0]);
    for (const auto& q : quads) std::fprintf(out, "3 %u %u %u\n3 %u %u %u\n", q[2], q[1], q[0], q[3], q[2], q[0]);
    return std::fclose(out) == 0 ? 0 : 1;
}
