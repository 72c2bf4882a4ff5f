#pragma once

#include "base/progress.h"

namespace scree {

/// While it lives, Ctrl-C (and SIGTERM) cancels `progress`; a second one ends the program at once with status 130.
/// One at a time.
class InterruptGuard {
public:
    explicit InterruptGuard(Progress& progress);
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
};

} // namespace scree
