#include "base/interrupt.h"

#include <atomic>
#include <csignal>

#include <unistd.h>

namespace scree {

namespace {

// Global, because a signal handler cannot reach anything else.
std::atomic<Progress*> guarded{nullptr};

void on_signal(int)
{
    Progress* progress = guarded.load();
    if (!progress || progress->cancelled()) _exit(130);
    progress->cancel();
}

} // namespace

InterruptGuard::InterruptGuard(Progress& progress)
{
    guarded = &progress;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
}

InterruptGuard::~InterruptGuard()
{
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    guarded = nullptr;
}

} // namespace scree
