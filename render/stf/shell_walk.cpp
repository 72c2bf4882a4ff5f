#include "render/stf/shell_walk.h"

namespace scree {

namespace {

class Walk {
public:
    Walk(const PhaseFunction& phase, double radius, Sampler& sampler)
        : phase_(phase), radius_(radius), sampler_(sampler)
    {
    }

    ShellWalk run(std::span<const ShellSampler> smaller)
    {
        for (;;) {
            const int k = Stf::largest(radius_ - place_.length(), smaller.size());
            if (k >= 0) {
                step(smaller[static_cast<size_t>(k)]);
                continue;
            }
            const double flight = -std::log(sampler_.next()), left = distance_out();
            if (flight >= left) {
                place_ += left * direction_;
                break;
            }
            place_ += flight * direction_;
            ++events_;
            note(place_, direction_, events_, std::exp(place_.length() - radius_));
            const double u = sampler_.next(), phi = 2 * pi * sampler_.next();
            cosine_ = phase_.sample(u);
            const double sine = safe_sqrt(1 - cosine_ * cosine_);
            direction_ = Frame(direction_).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine_}).normalized();
            scattered_at_ = place_;
        }
        walk_.exit = exit_at(place_ / radius_, direction_);
        walk_.exit.flight = static_cast<float>((place_ - scattered_at_).length());
        walk_.exit.cosine = static_cast<float>(cosine_);
        walk_.exit.events = events_;
        return walk_;
    }

private:
    /// Distance along the direction to the shell.
    double distance_out() const
    {
        const double along = place_.dot(direction_), square = radius_ * radius_ - place_.length2();
        return safe_sqrt(along * along + square) - along;
    }

    void step(const ShellSampler& shell)
    {
        const double r = shell.radius();
        if (sampler_.next() < std::exp(-r)) {
            place_ += r * direction_;
            return;
        }
        // Scatterings deep inside count little, so they are noted with an accordingly low probability.
        const double reached = std::exp(std::min(0.0, place_.length() + r - radius_));
        if (reached >= 1 || sampler_.next() < reached) note_one_of(shell, 1 / reached);
        const ShellFrame frame(direction_, sampler_.next());
        const ShellExit& exit = shell.exit(sampler_.next());
        const ShellPlace there = place_of(exit);
        place_ += r * frame.to_world(there.place);
        direction_ = frame.to_world(there.direction).normalized();
        scattered_at_ = place_ - double{exit.flight} * direction_;
        cosine_ = exit.cosine;
        events_ += exit.events;
    }

    /// Notes one of a shell's scatterings, with a weight that represents all of them.
    void note_one_of(const ShellSampler& shell, double weight)
    {
        const ShellFrame frame(direction_, sampler_.next());
        const ShellEvent& event = shell.event(sampler_.next());
        const V3d at = place_ + frame.to_world({event.aside, 0, event.along});
        // A smaller shell's scatterings are drawn by closeness to its own surface, not to this one's.
        weight *= shell.event_weight() * std::exp(at.length() - radius_) / shell.closeness(event);
        note(at, frame.to_world(V3d(event.direction)), events_ + event.events, weight);
    }

    void note(const V3d& place, const V3d& direction, uint32_t events, double weight)
    {
        walk_.event_sum += weight;
        if (sampler_.next() * walk_.event_sum >= weight) return;
        const double aside = std::hypot(place.x, place.y), c = aside > 0 ? place.x / aside : 1,
                     s = aside > 0 ? place.y / aside : 0;
        walk_.event = {static_cast<float>(place.z), static_cast<float>(aside),
                       V3f(V3d(direction.x * c + direction.y * s, direction.y * c - direction.x * s, direction.z)),
                       events};
    }

    const PhaseFunction& phase_;
    double radius_;
    Sampler& sampler_;
    V3d place_{0}, direction_{0, 0, 1}, scattered_at_{0};
    double cosine_ = 1;
    uint32_t events_ = 0;
    ShellWalk walk_;
};

} // namespace

ShellWalk walk_in_shell(const PhaseFunction& phase, double radius, std::span<const ShellSampler> smaller,
                        Sampler& sampler)
{
    return Walk(phase, radius, sampler).run(smaller);
}

} // namespace scree
