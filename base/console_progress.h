#pragma once

#include "base/progress.h"

#include <memory>
#include <string>

namespace scree {

/// Shows progress on standard error: a bar with the time left on a terminal, else a line per 5 % or per minute.
class ConsoleProgress {
public:
    /// quiet: shows nothing.
    explicit ConsoleProgress(bool quiet);
    ~ConsoleProgress();

    /// To be handed to the work; lives as long as this object.
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
