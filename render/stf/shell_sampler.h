#pragma once

#include "base/alias_table.h"
#include "render/stf/stf.h"

namespace scree {

/// Draws from the records of a shell by their weight in a medium of one albedo.
class ShellSampler {
public:
    /// 0 <= albedo <= 1. The shell must outlive this.
    ShellSampler(const StfShell& shell, double albedo);

    uint64_t bytes() const { return sizeof(*this) + exits_.bytes() + events_.bytes(); }
    double radius() const { return shell_->radius; }
    /// Share of light that the walks that scatter keep, the mean of albedo^events: the paper's
    /// (alpha_s^1 + alpha_s^m) / (1 - alpha_s^0).
    double survival() const { return survival_; }
    /// An exit, drawn by its share of the light that is kept; u uniform in (0, 1).
    const ShellExit& exit(double u) const { return shell_->exits[exits_.sample(u)]; }

    /// Mean over walks that scatter of the sum over their scatterings of closeness times albedo^events.
    double event_weight() const { return event_weight_; }
    /// A scattering, drawn by its share of that sum; u uniform in (0, 1).
    const ShellEvent& event(double u) const { return shell_->events[events_.sample(u)]; }
    double closeness(const ShellEvent& event) const { return shell_->closeness(event); }

private:
    const StfShell* shell_;
    AliasTable exits_, events_;
    double survival_ = 0, event_weight_ = 0;
};

} // namespace scree
