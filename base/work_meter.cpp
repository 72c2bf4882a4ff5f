#include "base/work_meter.h"

#include <malloc.h>
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <string>

namespace scree {

namespace {

double clock_seconds(clockid_t clock)
{
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

WorkTime now() { return {clock_seconds(CLOCK_MONOTONIC), clock_seconds(CLOCK_PROCESS_CPUTIME_ID)}; }

/// The value of a line of /proc/self/status in bytes; 0 if there is no such line.
uint64_t status_bytes(const std::string& key)
{
    std::ifstream in("/proc/self/status");
    for (std::string line; std::getline(in, line);) {
        if (line.rfind(key + ":", 0) == 0) return 1024 * std::stoull(line.substr(key.size() + 1));
    }
    return 0;
}

/// The peak before a meter last reset the kernel's peak. Global, because the kernel keeps one peak per process.
std::atomic<uint64_t> peak_before{0};

uint64_t kernel_peak()
{
    if (const uint64_t bytes = status_bytes("VmHWM"); bytes > 0) return bytes;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

} // namespace

WorkMeter::WorkMeter() : start_(now()) {}

WorkTime WorkMeter::time() const
{
    const WorkTime t = now();
    return {t.wall - start_.wall, t.processor - start_.processor};
}

MemoryMeter::MemoryMeter()
{
    peak_before = peak_bytes();
    malloc_trim(0); // memory that was freed but not returned to the system would hide new use
    std::ofstream("/proc/self/clear_refs") << "5"; // resets the peak to the current use (proc(5))
    start_ = resident_bytes();
}

uint64_t MemoryMeter::peak() const { return std::max(kernel_peak(), start_) - start_; }

uint64_t resident_bytes() { return status_bytes("VmRSS"); }

uint64_t peak_bytes() { return std::max(peak_before.load(), kernel_peak()); }

} // namespace scree
