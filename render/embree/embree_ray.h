#pragma once

// Private to the sources that ask Embree: it shows Embree's header.

#include "base/math.h"

#include <embree3/rtcore.h>

namespace scree {

/// A nearest-hit query along o + t d, 0 <= t <= tfar, without a hit yet.
inline RTCRayHit make_ray(const V3d& o, const V3d& d, double tfar)
{
    RTCRayHit ray;
    ray.ray.org_x = static_cast<float>(o.x);
    ray.ray.org_y = static_cast<float>(o.y);
    ray.ray.org_z = static_cast<float>(o.z);
    ray.ray.dir_x = static_cast<float>(d.x);
    ray.ray.dir_y = static_cast<float>(d.y);
    ray.ray.dir_z = static_cast<float>(d.z);
    ray.ray.tnear = 0;
    ray.ray.tfar = static_cast<float>(tfar);
    ray.ray.time = 0;
    ray.ray.mask = ~0u;
    ray.ray.id = 0;
    ray.ray.flags = 0;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return ray;
}

} // namespace scree
