#pragma once

#include "base/progress.h"

namespace scree {

/// While this object exists, Ctrl-C (or SIGTERM) cancels `progress`; a second signal ends the program at once with
/// status 130. Only one may exist at a time.
class InterruptGuard {
public:
    explicit InterruptGuard(Progress& progress);
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
};

} // namespace scree
