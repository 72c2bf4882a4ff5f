#include "render/grains/library/half_spaces.h"
#include "render/grains/library/radial_surface.h"
#include "render/grains/library/shape_generator.h"
#include "render/grains/library/shape_random.h"

#include "base/noise.h"

namespace scree {

namespace {

/// A face of the habit by its Miller indices, and how far from the middle it grows.
struct Form {
    double h, k, l;
    double distance;
};

/// The forms of the common habit of sucrose (class 2: the axis b is polar, so that p and p' differ), flattened along
/// c*.
constexpr Form habit[] = {{1, 0, 0, 0.62},  {-1, 0, 0, 0.62},  {0, 0, 1, 0.56}, {0, 0, -1, 0.56},
                          {1, 0, 1, 0.69},  {-1, 0, -1, 0.69}, {1, 1, 0, 0.80}, {-1, 1, 0, 0.80},
                          {1, -1, 0, 0.72}, {-1, -1, 0, 0.72}, {0, 1, 1, 0.84}, {0, 1, -1, 0.84}};

/// Unit normal of a face: h a* + k b* + l c* of the monoclinic cell a 1.0863, b 0.8705, c 0.7758 nm, beta 102.95
/// degrees (Brown and Levy 1973).
V3d face_normal(const Form& form)
{
    constexpr double a = 1.0863, b = 0.8705, c = 0.7758;
    constexpr double sine = 0.97457, cosine = -0.22410; // of beta
    // a = (a, 0, 0), b = (0, b, 0), c = (c cosine, 0, c sine).
    const V3d a_star(1 / a, 0, -cosine / (a * sine)), b_star(0, 1 / b, 0), c_star(0, 0, 1 / (c * sine));
    return (form.h * a_star + form.k * b_star + form.l * c_star).normalized();
}

/// The faces of one crystal, each grown more or less than in the habit.
std::vector<HalfSpace> grow(ShapeRandom& random, double variation, double elongation)
{
    std::vector<HalfSpace> faces;
    for (const Form& form : habit) {
        const V3d n = face_normal(form);
        const double stretch = 1 + (elongation - 1) * n.y * n.y; // crystals are longest along b
        faces.push_back({n, form.distance * stretch * (1 + variation * random.uniform(-1, 1))});
    }
    return faces;
}

/// Cuts off corners of the polyhedron with planes a little inside the corners.
void chip(std::vector<HalfSpace>& faces, uint64_t count, double depth, ShapeRandom& random)
{
    const TriangleMesh solid = convex_polyhedron(faces);
    for (uint64_t i = 0; i < count; ++i) {
        const auto corner = static_cast<size_t>(random.uniform() * static_cast<double>(solid.positions.size()));
        const V3d p = solid.positions[corner];
        const V3d n = (p.normalized() + 0.5 * random.in_ball()).normalized();
        faces.push_back({n, n.dot(p) - depth * random.uniform(0.25, 1)});
    }
}

Imath::M33d random_rotation(ShapeRandom& random)
{
    const V3d z = random.direction(), x = z.cross(random.direction()).normalized(), y = z.cross(x);
    return {x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z};
}

} // namespace

TriangleMesh make_crystal(const ShapeRequest& request)
{
    ShapeRandom random(request.seed, 0x637279);
    const auto intergrown = static_cast<size_t>(request["intergrown"]);
    std::vector<std::vector<HalfSpace>> crystals;
    for (size_t i = 0; i < intergrown; ++i) {
        std::vector<HalfSpace> faces = grow(random, request["variation"], request["elongation"]);
        const auto chips = static_cast<uint64_t>(request["chips"]);
        // A coarse mesh has no room for every face, so a coarse single crystal gets no chips.
        if (intergrown > 1 || request.triangles >= 200) chip(faces, chips, request["chip_depth"], random);
        if (i > 0) {
            const Imath::M33d rotation = random_rotation(random);
            const double size = random.uniform(0.55, 0.85);
            const V3d offset = 0.45 * random.direction();
            for (HalfSpace& face : faces) {
                face.normal = face.normal * rotation;
                // The origin must stay inside, well away from the face.
                face.distance = std::max(0.1, size * face.distance + face.normal.dot(offset));
            }
        }
        crystals.push_back(std::move(faces));
    }

    NoiseOptions bumps;
    bumps.scale = V3d(0.5);
    bumps.octaves = 1 + static_cast<int>(std::clamp(std::log2(0.25 / mean_edge(request.triangles)), 0.0, 4.0));
    bumps.seed = random.next();
    const FractalNoise noise(bumps);
    const double roughness = request["roughness"], rounding = request["rounding"];
    const double fillet = 0.04; // of the creases between intergrown crystals
    const RadialFunction radius = [&](const V3d& d) {
        double r = rounded_distance(crystals[0], rounding, d);
        if (crystals.size() > 1) {
            std::vector<double> all{r};
            for (size_t i = 1; i < crystals.size(); ++i) all.push_back(rounded_distance(crystals[i], rounding, d));
            const double largest = std::ranges::max(all);
            double sum = 0;
            for (const double x : all) sum += std::pow(x / largest, 1 / fillet);
            r = largest * std::pow(sum, fillet);
        }
        return r * (1 + roughness * noise(r * d));
    };
    // The mesh of a single crystal starts from the crystal's faces, so that it has edges where the solid has them.
    if (crystals.size() == 1) {
        TriangleMesh solid = convex_polyhedron(crystals[0]);
        if (solid.triangles.size() <= request.triangles)
            return radial_surface(radius, std::move(solid), request.triangles);
    }
    return radial_surface(radius, request.triangles);
}

} // namespace scree
