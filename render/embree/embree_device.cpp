#include "render/embree/embree_device.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <pmmintrin.h>
#include <stdexcept>
#include <xmmintrin.h>

namespace scree {

namespace {

bool count_bytes(void* counter, ssize_t bytes, bool)
{
    static_cast<std::atomic<int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
    return true;
}

} // namespace

EmbreeDevice::EmbreeDevice() : device_(rtcNewDevice(nullptr))
{
    if (!device_) throw std::runtime_error("Embree has no device for this machine");
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
}

EmbreeDevice::~EmbreeDevice() { rtcReleaseDevice(device_); }

void EmbreeDevice::check(const char* what) const
{
    const RTCError error = rtcGetDeviceError(device_);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::runtime_error(fmt::format("out of memory while {}", what));
    throw std::runtime_error(fmt::format("Embree error {} while {}", static_cast<int>(error), what));
}

void flush_subnormals()
{
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
}

} // namespace scree
