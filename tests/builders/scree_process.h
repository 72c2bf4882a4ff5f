#pragma once

#include <string>
#include <vector>

namespace scree::test {

/// The result of a run of the built program, which starts without a shell.
struct ProgramRun {
    int status = -1; ///< exit code; 128 + n for signal n
    std::string out, err;
    double seconds = 0;
};

/// The path of the built `scree`.
std::string scree_program();

/// Runs `scree` with these arguments; when its error output first contains `signal_at`, waits `signal_after` seconds
/// and sends SIGINT.
ProgramRun run_scree(const std::vector<std::string>& arguments, const std::string& signal_at = "",
                     double signal_after = 0, const std::string& program = scree_program());

} // namespace scree::test
