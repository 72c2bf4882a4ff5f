#pragma once

#include "base/math.h"
#include "render/media/phase_function.h"

#include <memory>
#include <vector>

namespace scree {

// Shell transport functions (STF; Moon et al. 2007; f_s in Müller et al. 2016): how light leaves a ball of a
// homogeneous medium when it starts at the centre x_c. Lengths are in mean free paths. The light starts along +z, the
// paper's omega_c. Places lie in the plane of x and z, with x not negative.

/// How a walk left a shell: the place x_s and the direction omega_s in the paper.
struct ShellExit {
    float cos_t = 1; ///< cosine of theta_t, the angle between the axis and the place, seen from the centre
    float away = 0; ///< component of the direction along growing theta_t
    float across = 0; ///< component along y; the third component, outwards, is not negative
    float flight = 0; ///< distance since the last scattering
    float cosine = 1; ///< of the angle of the last scattering
    uint32_t events = 0; ///< scatterings; at least 1
};

/// A scattering within a shell.
struct ShellEvent {
    float along = 0, aside = 0; ///< place: z and x
    V3f direction{0, 0, 1}; ///< before the scattering
    uint32_t events = 0; ///< scatterings up to here, this one counted; at least 1
};

/// Walks in a shell of one radius that scatter at least once: the share 1 - exp(-radius) of all walks, the paper's
/// 1 - alpha_s^0(r).
///
/// Walks are lossless: at an albedo below 1 a walk has the weight albedo^events. Exits of one event make up the paper's
/// alpha_s^1, all others alpha_s^m and p_s^m.
struct StfShell {
    double radius = 0; ///< the paper's r
    std::vector<ShellExit> exits;
    std::vector<float> exit_weights; ///< sum to 1
    /// Scatterings of walks, drawn by closeness(): near the surface, where light from outside may reach them.
    std::vector<ShellEvent> events;
    std::vector<float> event_weights; ///< sum to 1
    double event_sum = 0; ///< mean over walks of the sum of closeness over their scatterings

    /// exp(-depth below the surface).
    double closeness(const ShellEvent& event) const { return std::exp(std::hypot(event.along, event.aside) - radius); }
};

/// Shells of ascending radius of one medium.
class Stf {
public:
    static constexpr int steps_per_octave = 2;
    /// Radius of shell k, in mean free paths: 1, sqrt 2, 2, ...
    static double radius(size_t k) { return std::exp2(static_cast<double>(k) / steps_per_octave); }
    /// The largest k < count with radius(k) <= limit; -1 where there is none.
    static int largest(double limit, size_t count);

    Stf() = default;
    explicit Stf(double g) : phase(g) {}
    explicit Stf(std::shared_ptr<const PhaseTable> table) : phase_table(std::move(table)), phase(phase_table.get()) {}

    std::shared_ptr<const PhaseTable> phase_table; ///< or null
    PhaseFunction phase;
    std::vector<StfShell> shells; ///< from radius(0) on

    uint64_t bytes() const;
};

/// The axes of a shell whose light starts along `axis`; u in 0..1 chooses the turn about the axis, and whether the
/// shell is mirrored.
class ShellFrame {
public:
    ShellFrame(const V3d& axis, double u) : frame_(axis), mirror_(u < 0.5 ? 1 : -1)
    {
        const double phi = 4 * pi * u; // each mirror image gets a whole turn
        cos_ = std::cos(phi);
        sin_ = std::sin(phi);
    }
    V3d to_world(const V3d& v) const
    {
        const double y = mirror_ * v.y;
        return frame_.to_world({cos_ * v.x - sin_ * y, sin_ * v.x + cos_ * y, v.z});
    }

private:
    Frame frame_;
    double mirror_, cos_, sin_;
};

/// A place on a sphere of radius 1 around the centre, and the direction of an exit, both with +z as axis.
struct ShellPlace {
    V3d place, direction;
};
ShellPlace place_of(const ShellExit& exit);
/// The exit at a place (on the unit sphere) in a direction; flight, cosine and events are left to the caller.
ShellExit exit_at(const V3d& place, const V3d& direction);

} // namespace scree
