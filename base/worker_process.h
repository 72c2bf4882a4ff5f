#pragma once

#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace scree {

/// What came of a program run aside.
struct WorkerResult {
    bool finished = false; ///< it ended by itself with status 0
    int status = -1; ///< its exit status, when it ended by itself
    std::string trouble; ///< what happened else, in words
    std::vector<char> output; ///< what it wrote
};

/// Runs a program that reads `input` from its standard input and writes to its standard output, and waits for it.
///
/// Whatever it does, this returns: after `timeout`, or when it writes more than `most_output` bytes, it is killed. Its
/// standard error goes nowhere. Throws nothing but std::bad_alloc.
WorkerResult run_worker(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                        std::span<const char> input, std::chrono::milliseconds timeout, size_t most_output);

} // namespace scree
