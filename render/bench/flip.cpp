#include "render/bench/flip.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace scree {

namespace {

// All numbers are those of Andersson et al. 2020, sections 4.1 to 4.3.
constexpr double exponent_color = 0.7, exponent_feature = 0.5;
constexpr double knee = 0.4, at_knee = 0.95; // p_c, p_t
constexpr double feature_width = 0.082; // degrees: the width of an edge or point

/// A contrast sensitivity as a sum of two Gaussians: a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr Sensitivity achromatic{1, 0.0047, 0, 1e-5}, red_green{1, 0.0053, 0, 1e-5},
    blue_yellow{34.1, 0.04, 13.5, 0.025};
constexpr double widest = 0.04; // the largest b: all kernels extend to three of its standard deviations

using Plane = std::vector<double>;

struct Size {
    int width, height;
};

/// Convolves one channel with a separable kernel; beyond the border the border pixels repeat.
Plane convolve(const Plane& plane, Size size, const std::vector<double>& along_x, const std::vector<double>& along_y)
{
    const int rx = static_cast<int>(along_x.size() / 2), ry = static_cast<int>(along_y.size() / 2);
    const auto at = [&](int x, int y) {
        return static_cast<size_t>(y) * static_cast<size_t>(size.width) + static_cast<size_t>(x);
    };
    Plane rows(plane.size()), result(plane.size());
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            double sum = 0;
            for (int k = -rx; k <= rx; ++k)
                sum += along_x[static_cast<size_t>(k + rx)] * plane[at(std::clamp(x + k, 0, size.width - 1), y)];
            rows[at(x, y)] = sum;
        }
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            double sum = 0;
            for (int k = -ry; k <= ry; ++k)
                sum += along_y[static_cast<size_t>(k + ry)] * rows[at(x, std::clamp(y + k, 0, size.height - 1))];
            result[at(x, y)] = sum;
        }
    return result;
}

std::vector<double> sampled(int radius, const std::function<double(double)>& f)
{
    std::vector<double> values;
    for (int k = -radius; k <= radius; ++k) values.push_back(f(k));
    return values;
}

double total(const std::vector<double>& v)
{
    double sum = 0;
    for (const double x : v) sum += x;
    return sum;
}

/// A channel filtered by the contrast sensitivity of the eye.
Plane seen(const Plane& plane, Size size, const Sensitivity& s, double ppd)
{
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * ppd));
    Plane result(plane.size(), 0.0);
    double weight = 0;
    for (const auto& [a, b] : {std::pair{s.a1, s.b1}, std::pair{s.a2, s.b2}}) {
        if (a == 0) continue;
        const std::vector<double> gauss =
            sampled(radius, [&](double k) { return std::exp(-pi * pi * k * k / (ppd * ppd * b)); });
        const double scale = a * std::sqrt(pi / b);
        const Plane part = convolve(plane, size, gauss, gauss);
        for (size_t i = 0; i < part.size(); ++i) result[i] += scale * part[i];
        weight += scale * total(gauss) * total(gauss);
    }
    for (double& v : result) v /= weight;
    return result;
}

/// Rec. 709 to CIE XYZ; the functions below divide by the white, D65, so that each channel of white is 1.
constexpr double to_xyz[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};

V3d relative_xyz(const V3d& rgb)
{
    V3d xyz;
    for (int i = 0; i < 3; ++i) {
        const auto& m = to_xyz[i];
        xyz[i] = (m[0] * rgb.x + m[1] * rgb.y + m[2] * rgb.z) / (m[0] + m[1] + m[2]);
    }
    return xyz;
}

V3d from_relative_xyz(const V3d& xyz)
{
    static const Imath::M33d inverse = [] {
        Imath::M33d m; // Imath multiplies row vectors by matrices
        for (int i = 0; i < 3; ++i) {
            const double white = to_xyz[i][0] + to_xyz[i][1] + to_xyz[i][2];
            for (int j = 0; j < 3; ++j) m[j][i] = to_xyz[i][j] / white;
        }
        return m.inverse();
    }();
    return xyz * inverse;
}

/// Linear opponent colours, in which the eye's filters are known: Y_y, C_x, C_z.
V3d to_opponent(const V3d& rgb)
{
    const V3d xyz = relative_xyz(rgb);
    return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

V3d from_opponent(const V3d& c)
{
    const double y = (c.x + 16) / 116;
    return from_relative_xyz({y + c.y / 500, y, y - c.z / 200});
}

/// CIE L*a*b* with the chroma of dark colours reduced (Hunt effect).
V3d hunt_lab(const V3d& rgb)
{
    const V3d xyz = relative_xyz(rgb);
    const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
    const double l = 116 * f(xyz.y) - 16;
    return {l, 0.01 * l * 500 * (f(xyz.x) - f(xyz.y)), 0.01 * l * 200 * (f(xyz.y) - f(xyz.z))};
}

/// Distance for large colour differences (Abasi et al. 2020).
double hyab(const V3d& a, const V3d& b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

V3d cut(const V3d& c) { return {std::clamp(c.x, 0.0, 1.0), std::clamp(c.y, 0.0, 1.0), std::clamp(c.z, 0.0, 1.0)}; }

/// A picture as the eye sees it: its colours for the colour distance, and its luminance for the features.
struct Seen {
    std::vector<V3d> colors;
    Plane light;
};

Seen look_at(const ScreenPicture& picture, double ppd)
{
    Seen result;
    Plane planes[3];
    for (const V3d& pixel : picture.pixels) {
        const V3d opponent = to_opponent(cut(pixel));
        for (int c = 0; c < 3; ++c) planes[c].push_back(opponent[c]);
        result.light.push_back((opponent.x + 16) / 116);
    }
    const Size size{picture.width, picture.height};
    const Sensitivity sensitivities[] = {achromatic, red_green, blue_yellow};
    for (int c = 0; c < 3; ++c) planes[c] = seen(planes[c], size, sensitivities[c], ppd);
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
        result.colors.push_back(hunt_lab(cut(from_opponent({planes[0][i], planes[1][i], planes[2][i]}))));
    }
    return result;
}

/// Makes the positive values sum to 1 and the negative ones to -1.
std::vector<double> balanced(std::vector<double> kernel)
{
    double above = 0, below = 0;
    for (const double v : kernel) (v > 0 ? above : below) += std::abs(v);
    for (double& v : kernel) v /= v > 0 ? above : below;
    return kernel;
}

/// The magnitude of the derivative along x and y: the first order finds edges, the second points.
Plane feature(const Plane& light, Size size, int order, double ppd)
{
    const double deviation = 0.5 * feature_width * ppd, square = deviation * deviation;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    std::vector<double> gauss = sampled(radius, [&](double k) { return std::exp(-k * k / (2 * square)); });
    const std::vector<double> slope = balanced(sampled(radius, [&](double k) {
        const double g = std::exp(-k * k / (2 * square));
        return order == 1 ? -k * g : (k * k / square - 1) * g;
    }));
    const double weight = total(gauss);
    for (double& v : gauss) v /= weight;
    const Plane dx = convolve(light, size, slope, gauss), dy = convolve(light, size, gauss, slope);
    Plane result;
    for (size_t i = 0; i < dx.size(); ++i) result.push_back(std::hypot(dx[i], dy[i]));
    return result;
}

/// Maps colour differences to 0..1: those up to the knee take at_knee of the range.
double spread(double difference, double largest)
{
    const double at = knee * largest;
    return difference < at ? at_knee / at * difference : at_knee + (difference - at) / (largest - at) * (1 - at_knee);
}

} // namespace

std::vector<double> flip_difference(const ScreenPicture& reference, const ScreenPicture& test, double pixels_per_degree)
{
    const Size size{reference.width, reference.height};
    const Seen r = look_at(reference, pixels_per_degree), t = look_at(test, pixels_per_degree);
    const Plane r_edges = feature(r.light, size, 1, pixels_per_degree),
                t_edges = feature(t.light, size, 1, pixels_per_degree);
    const Plane r_points = feature(r.light, size, 2, pixels_per_degree),
                t_points = feature(t.light, size, 2, pixels_per_degree);
    const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), exponent_color);
    std::vector<double> map;
    map.reserve(r.colors.size());
    for (size_t i = 0; i < r.colors.size(); ++i) {
        const double color = spread(std::pow(hyab(r.colors[i], t.colors[i]), exponent_color), largest);
        const double most = std::max(std::abs(r_edges[i] - t_edges[i]), std::abs(r_points[i] - t_points[i]));
        const double feature_difference = std::clamp(std::pow(most / std::sqrt(2.0), exponent_feature), 0.0, 1.0);
        map.push_back(std::pow(color, 1 - feature_difference));
    }
    return map;
}

double mean_flip(const std::vector<double>& map)
{
    return map.empty() ? 0 : total(map) / static_cast<double>(map.size());
}

} // namespace scree
