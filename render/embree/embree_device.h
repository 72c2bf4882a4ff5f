#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

struct RTCDeviceTy;

namespace scree {

/// An Embree device that counts the memory it holds and turns Embree's error codes into exceptions.
class EmbreeDevice {
public:
    EmbreeDevice();
    ~EmbreeDevice();
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    RTCDeviceTy* get() const { return device_; }
    int64_t bytes() const { return bytes_.load(std::memory_order_relaxed); }
    /// Throws std::runtime_error when Embree has reported an error since the last check. what: the task, as in
    /// "building an exemplar".
    void check(const char* what) const;

private:
    RTCDeviceTy* device_;
    std::atomic<int64_t> bytes_{0};
};

/// Sets this thread to flush subnormal floats to zero, as Embree recommends.
void flush_subnormals();

} // namespace scree
