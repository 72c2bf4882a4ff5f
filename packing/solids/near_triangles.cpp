#include "packing/solids/near_triangles.h"

#include <algorithm>
#include <cmath>

namespace scree {

using Imath::V3d;

void NearTriangles::resize(size_t n)
{
    for (auto* list : {&x_, &y_, &z_, &normal_x_, &normal_y_, &normal_z_, &radius_, &thickness_}) list->resize(n);
    corners_.resize(n);
}

void NearTriangles::fill(const std::vector<Corners>& triangles, double scale)
{
    scale_ = scale;
    resize(triangles.size());
    for (size_t k = 0; k < triangles.size(); ++k) {
        const V3d a = triangles[k][0] * scale, b = triangles[k][1] * scale, c = triangles[k][2] * scale;
        const V3d middle = (a + b + c) / 3;
        // With any unit vector as the normal, the cylinder contains the triangle.
        V3d normal = (b - a).cross(c - a).normalized();
        if (!(std::abs(normal.length2() - 1) < 1e-6)) normal = V3d(1, 0, 0);
        double radius = 0, thickness = 0;
        for (const V3d& corner : {a, b, c}) {
            radius = std::max(radius, (corner - middle).length());
            thickness = std::max(thickness, std::abs(normal.dot(corner - middle)));
        }
        x_[k] = middle.x, y_[k] = middle.y, z_[k] = middle.z;
        normal_x_[k] = normal.x, normal_y_[k] = normal.y, normal_z_[k] = normal.z;
        radius_[k] = radius, thickness_[k] = thickness;
        corners_[k] = &triangles[k];
    }
}

DistanceBounds NearTriangles::distance(const V3d& place)
{
    const size_t n = corners_.size();
    least_.resize(n);
    const V3d p = place * scale_;
    // Bound on rounding: it is some ten times 2^-53 of the places that are subtracted.
    const double rounding = (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) + 4) * 0x1p-48;
    for (size_t k = 0; k < n; ++k) {
        const double x = p.x - x_[k], y = p.y - y_[k], z = p.z - z_[k];
        const double square = x * x + y * y + z * z;
        const double height = std::abs(x * normal_x_[k] + y * normal_y_[k] + z * normal_z_[k]);
        // The difference of nearly equal squares is off by a few units of the larger one.
        const double aside = std::sqrt(std::max(square * (1 - 0x1p-48) - height * height, 0.0));
        const double h = std::max(height - thickness_[k], 0.0), t = std::max(aside - radius_[k], 0.0);
        least_[k] = std::sqrt(h * h + t * t) - rounding;
    }
    const auto first = static_cast<size_t>(std::min_element(least_.begin(), least_.end()) - least_.begin());
    DistanceBounds nearest = bound_distance(place, *corners_[first], scale_);
    for (size_t k = 0; k < n; ++k) {
        if (least_[k] > nearest.hi || k == first) continue;
        const DistanceBounds d = bound_distance(place, *corners_[k], scale_);
        nearest.lo = std::min(nearest.lo, d.lo);
        nearest.hi = std::min(nearest.hi, d.hi);
    }
    return {nearest.lo / scale_, nearest.hi / scale_};
}

void NearTriangles::pick(const NearTriangles& larger, double within)
{
    scale_ = larger.scale_;
    const double limit = within * scale_ * (1 + 1e-12);
    resize(larger.corners_.size());
    size_t n = 0;
    for (size_t k = 0; k < larger.corners_.size(); ++k) {
        x_[n] = larger.x_[k], y_[n] = larger.y_[k], z_[n] = larger.z_[k];
        normal_x_[n] = larger.normal_x_[k], normal_y_[n] = larger.normal_y_[k], normal_z_[n] = larger.normal_z_[k];
        radius_[n] = larger.radius_[k], thickness_[n] = larger.thickness_[k];
        corners_[n] = larger.corners_[k];
        n += !(larger.least_[k] > limit);
    }
    resize(n);
}

} // namespace scree
