#pragma once

#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace scree {

/// Result of a program that ran as a separate process.
struct WorkerResult {
    bool finished = false; ///< it ended by itself with status 0
    int status = -1; ///< its exit status, when it ended by itself
    std::string trouble; ///< what went wrong otherwise, in words
    std::vector<char> output; ///< what it wrote to its standard output
};

/// Runs a program that reads `input` from its standard input and writes to its standard output, and waits for it.
///
/// This call always returns: the program is killed after `timeout`, or when it writes more than `most_output` bytes.
/// The program's standard error is discarded. Throws nothing but std::bad_alloc.
WorkerResult run_worker(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                        std::span<const char> input, std::chrono::milliseconds timeout, size_t most_output);

} // namespace scree
