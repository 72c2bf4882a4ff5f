#include "render/bench/machine.h"

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
    machine.date = fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
    return machine;
}

} // namespace scree
