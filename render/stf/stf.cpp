#include "render/stf/stf.h"

namespace scree {

uint64_t Stf::bytes() const
{
    uint64_t sum = 0;
    for (const StfShell& shell : shells) {
        sum += shell.exits.size() * (sizeof(ShellExit) + sizeof(float)) +
               shell.events.size() * (sizeof(ShellEvent) + sizeof(float));
    }
    return sum;
}

int Stf::largest(double limit, size_t count)
{
    if (!(limit >= 1) || count == 0) return -1;
    int k = static_cast<int>(std::min(std::floor(std::log2(limit) * steps_per_octave), static_cast<double>(count - 1)));
    while (k >= 0 && radius(static_cast<size_t>(k)) > limit) --k; // log2 may round up
    return k;
}

ShellPlace place_of(const ShellExit& exit)
{
    const double c = exit.cos_t, s = safe_sqrt(1 - c * c), away = exit.away, across = exit.across;
    const double out = safe_sqrt(1 - away * away - across * across);
    return {V3d(s, 0, c), V3d(out * s + away * c, across, out * c - away * s)};
}

ShellExit exit_at(const V3d& place, const V3d& direction)
{
    ShellExit exit;
    const double s = std::hypot(place.x, place.y), cos_phi = s > 0 ? place.x / s : 1, sin_phi = s > 0 ? place.y / s : 0;
    const double x = direction.x * cos_phi + direction.y * sin_phi;
    exit.cos_t = static_cast<float>(std::clamp(place.z, -1.0, 1.0));
    exit.away = static_cast<float>(x * place.z - direction.z * s);
    exit.across = static_cast<float>(direction.y * cos_phi - direction.x * sin_phi);
    return exit;
}

} // namespace scree
