#pragma once

#include "base/math.h"
#include "render/media/phase_function.h"

#include <memory>
#include <vector>

namespace scree {

// Shell transport functions (Moon et al. 2007; Müller et al. 2016): what becomes of light that sets out from the centre
// of a ball of a homogeneous medium. Lengths are in mean free paths; the light sets out along +z; places lie in the
// plane of x and z, x not negative.

/// How a walk left a shell.
struct ShellExit {
    float cos_t = 1; ///< of the angle theta_t between the axis and the place, seen from the centre
    float away = 0; ///< component of the direction along growing theta_t
    float across = 0; ///< and along y; the third, outwards, is not negative
    float flight = 0; ///< length of the way since the last scattering
    float cosine = 1; ///< of the last scattering's angle
    uint32_t events = 0; ///< scatterings; at least 1
};

/// A scattering within a shell.
struct ShellEvent {
    float along = 0, aside = 0; ///< place: z and x
    V3f direction{0, 0, 1}; ///< before the scattering
    uint32_t events = 0; ///< scatterings up to here, this one counted; at least 1
};

/// Walks in a shell of one radius that scatter at least once, the part 1 - exp(-radius) of all; lossless, so that an
/// albedo is a weight albedo^events.
struct StfShell {
    double radius = 0;
    std::vector<ShellExit> exits;
    std::vector<float> exit_weights; ///< sum to 1
    std::vector<ShellEvent>
        events; ///< scatterings of walks, drawn by their closeness(): where light from outside may reach them
    std::vector<float> event_weights; ///< sum to 1
    double event_sum = 0; ///< mean over walks of the sum of closeness over their scatterings

    double closeness(const ShellEvent& event) const { return std::exp(std::hypot(event.along, event.aside) - radius); }
};

/// Shells of growing radius of one medium.
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

/// The axes of a shell around a way that goes on along `axis`: turned about it, and mirrored or not, as u in 0..1 has
/// it.
class ShellFrame {
public:
    ShellFrame(const V3d& axis, double u) : frame_(axis), mirror_(u < 0.5 ? 1 : -1)
    {
        const double phi = 4 * pi * u; // each mirror image has a whole turn
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
