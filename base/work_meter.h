#pragma once

#include <cstdint>

namespace scree {

/// What work took: other programs of a busy machine count in the one and not in the other.
struct WorkTime {
    double wall = 0, processor = 0; ///< seconds; processor: of all threads together

    WorkTime& operator+=(const WorkTime& other)
    {
        wall += other.wall;
        processor += other.processor;
        return *this;
    }
};

/// Measures from its making.
class WorkMeter {
public:
    WorkMeter();
    WorkTime time() const;

private:
    WorkTime start_;
};

/// The most memory that was used at once since it was made. Where the system cannot tell that, since the program's
/// start.
class MemoryMeter {
public:
    MemoryMeter();
    /// Bytes above what was used at the start.
    uint64_t peak() const;

private:
    uint64_t start_ = 0;
};

/// Bytes of this program in use now, and the most there ever were, whatever meters were made in between.
uint64_t resident_bytes();
uint64_t peak_bytes();

} // namespace scree
