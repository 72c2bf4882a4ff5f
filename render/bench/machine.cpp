#include "render/bench/machine.h"

#include "base/content_hash.h"

#include <fmt/chrono.h>

#include <sched.h>

#include <chrono>
#include <fstream>

namespace scree {

Machine this_machine(int threads)
{
    Machine machine;
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; machine.processor.empty() && std::getline(in, line);) {
        const size_t colon = line.find(": ");
        if (line.rfind("model name", 0) == 0 && colon != std::string::npos) machine.processor = line.substr(colon + 2);
    }
    if (machine.processor.empty()) machine.processor = "unknown processor";
    cpu_set_t allowed;
    machine.cores = sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : 1;
    machine.threads = threads > 0 ? threads : machine.cores;
    machine.date =
        fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
    machine.build = build_identity();
    return machine;
}

const std::string& build_identity()
{
    static const std::string identity = [] {
        const uint64_t hash = hash_file("/proc/self/exe", 0);
        return hash == 0 ? std::string(SCREE_VERSION) : fmt::format("{:016x}", hash);
    }();
    return identity;
}

} // namespace scree
