// Every light's sampler against its density, cell by cell, because next-event estimation uses both.

#include "base/sampler.h"
#include "render/lights/light.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace scree {
namespace {

Light rectangle(const V3d& corner, const V3d& e1, const V3d& e2)
{
    Light light;
    light.kind = LightKind::rectangle;
    light.corner = corner;
    light.edge1 = e1;
    light.edge2 = e2;
    light.normal = e1.cross(e2).normalized();
    light.area = e1.cross(e2).length();
    return light;
}

Light sphere(const V3d& center, double radius)
{
    Light light;
    light.kind = LightKind::sphere;
    light.center = center;
    light.radius = radius;
    light.area = 4 * pi * radius * radius;
    return light;
}

Light distant(double degrees)
{
    Light light;
    light.kind = LightKind::distant;
    light.direction = V3d(0.3, -0.5, 0.7).normalized();
    light.one_minus_cos = 1 - std::cos(degrees * pi / 360);
    return light;
}

Light environment()
{
    const size_t w = 32, h = 16;
    std::vector<Color> texels(w * h);
    for (size_t y = 0; y < h; ++y) {
        for (size_t x = 0; x < w; ++x) {
            const float v = (x * 7 + y * 3) % 11 == 0 ? 5.0f : 0.1f * static_cast<float>(y);
            texels[y * w + x] = Color(v, 0.5f * v, 0.2f);
        }
    }
    Light light;
    light.kind = LightKind::environment;
    light.map = std::make_shared<EnvironmentMap>(texels, w, h, V3d(1, 2, 3), Color(2));
    return light;
}

/// Distance to the light along a direction, or a negative number if it is missed.
double distance_to(const Light& light, const V3d& p, const V3d& d)
{
    if (light.is_infinite()) return 1;
    if (light.kind == LightKind::rectangle) {
        const double t = (light.corner - p).dot(light.normal) / d.dot(light.normal);
        const V3d q = p + t * d - light.corner;
        const double u = q.dot(light.edge1) / light.edge1.length2(), v = q.dot(light.edge2) / light.edge2.length2();
        return t > 0 && u >= 0 && u <= 1 && v >= 0 && v <= 1 ? t : -1;
    }
    const V3d to = light.center - p;
    const double b = to.dot(d), disc = light.radius * light.radius - (to - b * d).length2();
    return disc > 0 && b > 0 ? b - std::sqrt(disc) : -1;
}

// Counts of sampled directions against the density integrated over 12 x 24 cells of the sphere around the light,
// by 400 stratified points a cell (a quadrature error well below the counting error of 100,000 draws).
TEST(Light, SamplesItsDensity)
{
    const V3d p(0.1, -0.2, 0.3);
    const std::vector<std::pair<std::string, Light>> lights{
        {"rectangle", rectangle({-0.5, -0.6, 1.5}, {1, 0, 0}, {0, 1.3, 0})},
        {"rectangle close and tilted", rectangle({-2, -2, 0.5}, {4, 0, 1}, {0, 4, 0})},
        {"sphere", sphere({1, 1, 1}, 0.6)},
        {"sphere close", sphere({0.1, -0.2, 1.35}, 1.0)},
        {"sun of 30 degrees", distant(30)},
        {"environment", environment()}};
    for (const auto& [name, light] : lights) {
        const LightSet set({light}, 1.0);
        // Cells around the light's middle: a cap that holds it.
        const V3d axis = light.kind == LightKind::sphere ? (light.center - p).normalized()
                         : light.kind == LightKind::rectangle
                             ? (light.corner + 0.5 * (light.edge1 + light.edge2) - p).normalized()
                         : light.kind == LightKind::distant ? light.direction
                                                            : V3d(0, 0, 1);
        const double cap = light.kind == LightKind::distant       ? 2 * light.one_minus_cos
                           : name == "sphere"                     ? 0.3
                           : light.kind == LightKind::environment ? 2
                                                                  : 1;
        const Frame frame(axis);
        constexpr int bands = 12, sectors = 24;
        const int n = 100000;
        std::vector<double> observed(bands * sectors + 1), expected(bands * sectors + 1);
        Sampler sampler(11, 0, 0, 0);
        for (int i = 0; i < n; ++i) {
            const double u0 = sampler.next(), u1 = sampler.next(), u2 = sampler.next();
            const LightSample s = set.sample(p, u0, u1, u2);
            ASSERT_TRUE(s.valid);
            ASSERT_NEAR(s.pdf, set.pdf(0, p, s.direction, s.distance), 1e-6 * s.pdf) << name;
            const V3d w = frame.to_local(s.direction);
            const double h = (1 - w.z) / cap;
            if (h >= 1) {
                observed.back() += 1;
                continue;
            }
            const double phi = std::atan2(w.y, w.x) / (2 * pi) + 0.5;
            observed[static_cast<size_t>(static_cast<int>(h * bands) * sectors +
                                         std::min(sectors - 1, static_cast<int>(phi * sectors)))] += 1;
        }
        double inside = 0;
        constexpr int m = 40;
        for (int cell = 0; cell < bands * sectors; ++cell) {
            double sum = 0;
            for (int k = 0; k < m * m; ++k) {
                const double z = 1 - cap * (cell / sectors + (k / m + sampler.next()) / m) / bands;
                const double phi = 2 * pi * ((cell % sectors + (k % m + sampler.next()) / m) / sectors - 0.5);
                const double r = std::sqrt(std::max(0.0, 1 - z * z));
                const V3d d = frame.to_world({r * std::cos(phi), r * std::sin(phi), z});
                const double t = distance_to(light, p, d);
                if (t > 0) sum += set.pdf(0, p, d, t);
            }
            expected[static_cast<size_t>(cell)] = n * sum / (m * m) * 2 * pi * cap / (bands * sectors);
            inside += expected[static_cast<size_t>(cell)];
        }
        expected.back() = std::max(0.0, n - inside);
        // A rectangle may reach beyond the cap; all directions outside are one more cell. Other lights fit in the cap.
        EXPECT_TRUE(light.kind == LightKind::rectangle || std::abs(n - inside) < 0.01 * n) << name << " " << inside / n;
        const ChiSquare test = chi_square(observed, expected);
        EXPECT_GT(test.p_value, sidak(0.001, static_cast<int>(lights.size()))) << name << ": " << test.text;
    }
}

TEST(Light, ManyAreChosenAsTheyAreWeighed)
{
    const LightSet set(
        {rectangle({-0.5, -0.6, 1.5}, {1, 0, 0}, {0, 1.3, 0}), sphere({3, 0, 0}, 0.5), distant(1), environment()}, 1.0);
    const V3d p(0);
    // The mean of radiance / pdf over samples is the integral of radiance, which is the sum over the single lights.
    Estimate all;
    Sampler sampler(4, 0, 0, 0);
    const auto sample = [&](const LightSet& lights) {
        const double u0 = sampler.next(), u1 = sampler.next(), u2 = sampler.next();
        const LightSample s = lights.sample(p, u0, u1, u2);
        return s.valid ? s.radiance.x / s.pdf : 0;
    };
    for (int i = 0; i < 400000; ++i) all.add(sample(set));
    double sum = 0, variance = 0;
    for (const Light& light : set.lights()) {
        const LightSet one({light}, 1.0);
        Estimate estimate;
        for (int i = 0; i < 400000; ++i) estimate.add(sample(one));
        sum += estimate.mean();
        variance += estimate.standard_error() * estimate.standard_error();
    }
    EXPECT_LT(std::abs(all.mean() - sum), 4 * std::hypot(all.standard_error(), std::sqrt(variance)));
}

TEST(Environment, TopRowLooksUp)
{
    std::vector<Color> texels(8 * 4, Color(0));
    for (size_t x = 0; x < 8; ++x) texels[x] = Color(1);
    const V3d up = V3d(1, -2, 0.5).normalized();
    const EnvironmentMap map(texels, 8, 4, up, Color(3));
    EXPECT_FLOAT_EQ(map.radiance(up).x, 3);
    EXPECT_FLOAT_EQ(map.radiance(-up).x, 0);
}

TEST(Environment, MiddleLooksAlongX)
{
    std::vector<Color> texels(64 * 32, Color(0));
    for (size_t y = 0; y < 32; ++y) {
        for (size_t x = 28; x < 36; ++x) texels[y * 64 + x] = Color(1);
        for (size_t x = 12; x < 20; ++x) texels[y * 64 + x] = Color(0, 1, 0);
    }
    const EnvironmentMap map(texels, 64, 32, V3d(0, 0, 1), Color(1));
    EXPECT_FLOAT_EQ(map.radiance({1, 0, 0}).x, 1);
    EXPECT_FLOAT_EQ(map.radiance({0, 1, 0}).y, 1);
    EXPECT_FLOAT_EQ(map.radiance({0, 1, 0}).x, 0);
    EXPECT_FLOAT_EQ(map.radiance({-1, 0, 0}).x, 0);
}

} // namespace
} // namespace scree
