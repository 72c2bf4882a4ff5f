#pragma once

#include <string>
#include <vector>

namespace scree::test {

/// The command line of the built program, run by a shell-free spawn.
struct ProgramRun {
    int status = -1; ///< exit code; 128 + n for signal n
    std::string out, err;
    double seconds = 0;
};

/// Where the built `scree` lies.
std::string scree_program();

/// Runs `scree` with these arguments; when its error output first holds `signal_at`, waits and sends SIGINT.
ProgramRun run_scree(const std::vector<std::string>& arguments, const std::string& signal_at = "",
                     double signal_after = 0, const std::string& program = scree_program());

} // namespace scree::test
