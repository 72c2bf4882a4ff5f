#include "base/console_progress.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>

#include <unistd.h>

namespace scree {

namespace {

using Clock = std::chrono::steady_clock;

std::string duration_text(double seconds)
{
    if (seconds < 60) return fmt::format("{:.0f} s", seconds);
    if (seconds < 3600) return fmt::format("{:.0f} min {:02.0f} s", std::floor(seconds / 60), std::fmod(seconds, 60));
    return fmt::format("{:.0f} h {:02.0f} min", std::floor(seconds / 3600), std::fmod(seconds / 60, 60));
}

} // namespace

struct ConsoleProgress::Impl {
    bool quiet;
    bool terminal = isatty(STDERR_FILENO) != 0;
    std::mutex mutex;
    std::string prefix, stage;
    Clock::time_point stage_start = Clock::now(), last_shown{};
    double last_fraction = -1;
    bool open_line = false;
    Progress progress;

    explicit Impl(bool quiet_)
        : quiet(quiet_), progress([this](const std::string& name, double fraction) { show(name, fraction); })
    {
    }

    void show(const std::string& name, double fraction)
    {
        if (quiet) return;
        const std::lock_guard lock(mutex);
        const auto now = Clock::now();
        if (name != stage) {
            close();
            stage = name;
            stage_start = now;
            last_shown = {};
            last_fraction = -1;
        }
        const double since = std::chrono::duration<double>(now - last_shown).count();
        const bool due = terminal
                             ? since > 0.1 || fraction >= 1
                             : fraction >= last_fraction + 0.05 || since > 60 || (fraction >= 1 && last_fraction < 1);
        if (!due) return;
        last_shown = now;
        last_fraction = fraction;
        const double elapsed = std::chrono::duration<double>(now - stage_start).count();
        const std::string left =
            fraction > 0.01 && fraction < 1 ? ", " + duration_text(elapsed * (1 - fraction) / fraction) + " left" : "";
        const std::string label = prefix.empty() ? stage : prefix + " " + stage;
        if (terminal) {
            constexpr int width = 30;
            const auto filled = static_cast<size_t>(fraction * width);
            fmt::print(stderr, "\r{} [{}{}] {:3.0f} %{}\033[K", label, std::string(filled, '#'),
                       std::string(width - filled, '.'), 100 * fraction, left);
            open_line = true;
        } else {
            fmt::print(stderr, "{} {:.0f} %{}\n", label, 100 * fraction, left);
        }
        std::fflush(stderr);
    }

    void close()
    {
        if (open_line) fmt::print(stderr, "\n");
        open_line = false;
    }
};

ConsoleProgress::ConsoleProgress(bool quiet) : impl_(std::make_unique<Impl>(quiet)) {}
ConsoleProgress::~ConsoleProgress() { finish(); }
Progress& ConsoleProgress::progress() { return impl_->progress; }

void ConsoleProgress::set_prefix(const std::string& prefix)
{
    const std::lock_guard lock(impl_->mutex);
    impl_->prefix = prefix;
}

void ConsoleProgress::finish()
{
    const std::lock_guard lock(impl_->mutex);
    impl_->close();
    impl_->stage.clear();
}

} // namespace scree
