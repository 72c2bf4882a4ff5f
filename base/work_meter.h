#pragma once

#include <cstdint>

namespace scree {

/// The time that a piece of work took; other programs on a busy machine add to `wall` but not to `processor`.
struct WorkTime {
    double wall = 0, processor = 0; ///< seconds; processor: sum over all threads

    WorkTime& operator+=(const WorkTime& other)
    {
        wall += other.wall;
        processor += other.processor;
        return *this;
    }
};

/// Measures the time since its construction.
class WorkMeter {
public:
    WorkMeter();
    WorkTime time() const;

private:
    WorkTime start_;
};

/// Measures the peak memory use since its construction (since the program's start where the system cannot reset it).
class MemoryMeter {
public:
    MemoryMeter();
    /// Peak in bytes, above the memory in use at construction.
    uint64_t peak() const;

private:
    uint64_t start_ = 0;
};

/// Bytes of memory that this program uses now.
uint64_t resident_bytes();
/// The most bytes that this program ever used, no matter which meters were made in between.
uint64_t peak_bytes();

} // namespace scree
