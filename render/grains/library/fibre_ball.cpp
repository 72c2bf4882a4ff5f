#include "render/grains/library/shape_generator.h"
#include "render/grains/library/shape_random.h"

namespace scree {

namespace {

/// A fibre's middle line: a walk of smoothly changing direction that is turned back at the ball's rim.
std::vector<V3d> wind(ShapeRandom& random, size_t points, double length, double curliness)
{
    constexpr size_t steps = 400; // of the walk; fixed, so that the fibre is the same at every tessellation
    std::vector<V3d> walk;
    const double rim = 0.97 - 0.35 * random.uniform() * random.uniform(); // a few fibres stand out
    V3d p = 0.85 * rim * random.in_ball(), direction = random.direction(), bend = random.in_ball();
    const double step = length / steps;
    for (size_t i = 0; i <= steps; ++i) {
        walk.push_back(p);
        bend =
            (bend + 0.35 * std::sqrt(step * 20) * random.in_ball()).normalized() * std::min(1.0, bend.length() + 0.1);
        V3d turn = curliness * bend;
        const double r = p.length();
        // Near the rim the fibre bends inwards, because in a wound ball the fibres run along the surface.
        if (r > 0.8 * rim) turn -= (12 * (r / rim - 0.8) / 0.2) * p / r;
        turn -= direction * turn.dot(direction);
        direction = (direction + step * turn).normalized();
        if (r > rim && direction.dot(p) > 0) direction = (direction - p * (direction.dot(p) / (r * r))).normalized();
        p += step * direction;
    }
    std::vector<V3d> line;
    for (size_t i = 0; i < points; ++i) {
        const double at = static_cast<double>(i) * steps / static_cast<double>(points - 1);
        const size_t k = std::min(steps - 1, static_cast<size_t>(at));
        line.push_back(walk[k] + (at - static_cast<double>(k)) * (walk[k + 1] - walk[k]));
    }
    return line;
}

/// Adds a closed tube with `sides` sides around the line; its frame is carried along the line without twist.
void add_tube(const std::vector<V3d>& line, size_t sides, double radius, TriangleMesh& mesh)
{
    const auto first = static_cast<uint32_t>(mesh.positions.size()), n = static_cast<uint32_t>(sides);
    V3d side = Frame((line[1] - line[0]).normalized()).s;
    for (size_t i = 0; i < line.size(); ++i) {
        const V3d along = (line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0]).normalized();
        side = (side - along * side.dot(along)).normalized();
        const V3d other = along.cross(side);
        for (uint32_t s = 0; s < n; ++s) {
            const double angle = 2 * pi * s / n;
            mesh.positions.push_back(line[i] + radius * (std::cos(angle) * side + std::sin(angle) * other));
        }
    }
    const auto rings = static_cast<uint32_t>(line.size());
    for (uint32_t i = 0; i + 1 < rings; ++i) {
        for (uint32_t s = 0; s < n; ++s) {
            const uint32_t a = first + i * n + s, b = first + i * n + (s + 1) % n;
            mesh.triangles.push_back({a, b, b + n});
            mesh.triangles.push_back({a, b + n, a + n});
        }
    }
    for (uint32_t s = 2; s < n; ++s) {
        mesh.triangles.push_back({first, first + s, first + s - 1});
        const uint32_t last = first + (rings - 1) * n;
        mesh.triangles.push_back({last, last + s - 1, last + s});
    }
}

} // namespace

TriangleMesh make_fibre_ball(const ShapeRequest& request)
{
    const uint64_t triangles = request.triangles;
    const size_t sides = triangles < 4000 ? 3 : triangles < 150000 ? 4 : 6;
    // With few triangles there are fewer fibres, so that each fibre has at least twelve pieces if possible.
    const uint64_t least = 2 * sides * 12 + 2 * (sides - 2);
    const uint64_t fibres = std::clamp<uint64_t>(triangles / least, 1, static_cast<uint64_t>(request["fibres"]));
    TriangleMesh mesh;
    for (uint64_t i = 0; i < fibres; ++i) {
        // One stream per fibre, so that more triangles show more fibres of the same ball.
        ShapeRandom random(request.seed, 0x66696200 + i);
        const uint64_t share = (i + 1) * triangles / fibres - i * triangles / fibres;
        const uint64_t pieces = std::max<uint64_t>(2, (share - 2 * (sides - 2)) / (2 * sides));
        add_tube(wind(random, pieces + 1, request["length"], request["curliness"]), sides, request["thickness"], mesh);
    }
    return mesh;
}

} // namespace scree
