#include "packing/report/hard_sphere_fluid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {

double RadiusMoments::mean_volume() const { return 4.0 / 3 * std::numbers::pi * m[3]; }

double RadiusMoments::polydispersity() const
{
    return m[1] > 0 ? std::sqrt(std::max(0.0, m[2] - m[1] * m[1])) / m[1] : 0;
}

double mean_void_chord(double fraction, const RadiusMoments& radii)
{
    return 4 * (1 - fraction) * radii.m[3] / (3 * fraction * radii.m[2]);
}

double carnahan_starling_contact(double fraction) { return (1 - fraction / 2) / std::pow(1 - fraction, 3); }

double bmcsl_contact(double fraction, const RadiusMoments& radii)
{
    const double* m = radii.m;
    // With sigma = r_i + r_j: <sigma^3>, <sigma^3 (2 r_i r_j / sigma)> and <sigma^3 (2 r_i r_j / sigma)^2>.
    const double whole = 2 * m[3] + 6 * m[2] * m[1];
    const double once = 2 * (2 * m[3] * m[1] + 2 * m[2] * m[2]);
    const double twice = 4 * 2 * m[3] * m[2];
    // xi_k = pi/6 rho <d^k>: xi_3 is the fraction and xi_2 = f <d^2> / <d^3>.
    const double xi2 = fraction * m[2] / (2 * m[3]), void_part = 1 - fraction;
    return 1 / void_part + 3 * xi2 / std::pow(void_part, 2) * once / whole +
           2 * xi2 * xi2 / std::pow(void_part, 3) * twice / whole;
}

std::vector<double> percus_yevick(double fraction, int steps_per_diameter, double x_max)
{
    // r h(r) = 12 f int_0^1 (r - t) h(|r - t|) Q(t) dt for r > 1, with Q(t) = a/2 (t^2 - 1) + b (t - 1) and h = -1
    // below 1. The trapezoid rule is applied separately on each side of the jump of h at contact.
    const size_t n = static_cast<size_t>(steps_per_diameter);
    const double dt = 1.0 / double(n), a = (1 + 2 * fraction) / std::pow(1 - fraction, 2),
                 b = -1.5 * fraction / std::pow(1 - fraction, 2);
    std::vector<double> q(n + 1);
    for (size_t k = 0; k <= n; ++k) {
        const double t = double(k) * dt;
        q[k] = a / 2 * (t * t - 1) + b * (t - 1);
    }
    const size_t last = static_cast<size_t>(std::ceil((x_max - 1) * double(n))) + n;
    std::vector<double> rh(last + 1); // r h(r); at contact the value from above
    for (size_t i = 0; i < n; ++i) rh[i] = -double(i) * dt;
    rh[n] = fraction * (2.5 * a + 4 * b);
    for (size_t i = n + 1; i <= last; ++i) {
        const size_t jump = std::min(i - n, n); // the step of t at which r - t is at contact
        double sum = 0;
        for (size_t k = 1; k <= jump; ++k) sum += (k == jump ? 0.5 : 1) * q[k] * rh[i - k];
        for (size_t k = jump; k < n; ++k) sum += (k == jump ? 0.5 : 1) * q[k] * (i - k == n ? -1 : rh[i - k]);
        rh[i] = 12 * fraction * dt * sum / (1 - 6 * fraction * dt * q[0]);
    }
    std::vector<double> g;
    for (size_t i = n; i <= last; ++i) g.push_back(1 + rh[i] / (double(i) * dt));
    return g;
}

} // namespace scree
