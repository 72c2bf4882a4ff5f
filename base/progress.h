#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace scree {

/// Progress and cancellation of one long piece of work; safe to use from many threads.
///
/// The worker calls `update` with the fraction done and stops early when `cancelled`. Code that shows progress passes a
/// Sink; code that wants to stop the work calls `cancel` (safe inside a signal handler).
class Progress {
public:
    /// Called with (stage, fraction in 0..1); from any thread, but never two at once for one stage's sink.
    using Sink = std::function<void(const std::string& stage, double fraction)>;

    Progress() = default;
    explicit Progress(Sink sink) : sink_(std::move(sink)) {}

    /// Reports that `fraction` of `stage` is done.
    void update(const std::string& stage, double fraction) const
    {
        if (sink_) sink_(stage, fraction);
    }

    void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
    bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

private:
    Sink sink_;
    std::atomic<bool> cancelled_{false};
};

} // namespace scree
