#include "render/grains/grain_store.h"

#include <limits>

namespace scree {

namespace {

double power_of_two_from(double x)
{
    int exponent = 0;
    std::frexp(x, &exponent);
    return std::ldexp(1, exponent);
}

} // namespace

FloatMargin::FloatMargin(double extent, double least, double largest)
{
    // A ray's start and direction are rounded to float (2^-24), and so is each of about ten operations that compute the
    // squared distance of the line from the centre. Start and centre are within four extents.
    const double error = 0x1p-19 * power_of_two_from(extent);
    // Widening by more than 2^-9 of a radius would cost more than it helps. So Embree may miss spheres below 2^-10 of
    // the extent at their rim.
    constexpr double most = 0x1p14;
    const double needed = std::ceil(error / least * 0x1p24);
    complete = needed <= most;
    ulps = static_cast<uint32_t>(std::min(most, needed));
    const double wider = largest * ulps * 0x1p-23;
    // The near faces of a sphere and of the widened sphere are at most this far apart along any line that hits both.
    // Rounded to a power of two, it is nearly always the same for a fill and for the list of its spheres.
    step_back = power_of_two_from(std::sqrt(2 * largest * wider + wider * wider) + error);
}

void GrainStore::widen()
{
    if (size() == 0) return;
    double extent = 1, least = std::numeric_limits<double>::infinity(), largest = 0;
    for (uint32_t i = 0; i < size(); ++i) {
        const Sphere& s = spheres[i];
        const double r = s.r;
        extent = std::max({extent, std::abs(double{s.x}) + r, std::abs(double{s.y}) + r, std::abs(double{s.z}) + r});
        least = std::min(least, r);
        largest = std::max(largest, r);
    }
    margin = FloatMargin(extent, least, largest);
    for (uint32_t i = 0; i < size(); ++i) spheres[i].r = margin.widen(spheres[i].r);
}

} // namespace scree
