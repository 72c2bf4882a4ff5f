#pragma once

#include "base/progress.h"

#include <memory>
#include <string>

namespace scree {

/// Shows progress on standard error: on a terminal a bar with the time left, otherwise one line per 5 % or per minute.
class ConsoleProgress {
public:
    /// quiet: show nothing.
    explicit ConsoleProgress(bool quiet);
    ~ConsoleProgress();

    /// The Progress to pass to the work; valid as long as this object.
    Progress& progress();
    /// Text shown before the stage, e.g. "frame 3/10".
    void set_prefix(const std::string& prefix);
    /// Ends the bar's line, if one is open.
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
