#include "render/scene/camera.h"

namespace scree {

Camera::Camera(const CameraDescription& description, int width, int height)
    : kind_(description.kind), origin_(description.origin), lens_radius_(0.5 * description.aperture), width_(width),
      height_(height)
{
    const V3d view = description.target - description.origin;
    forward_ = view.normalized();
    right_ = forward_.cross(description.up).normalized();
    up_ = right_.cross(forward_);
    focus_ = description.focus > 0 ? description.focus : view.length();
    if (kind_ == CameraKind::perspective) {
        const double half = std::tan(description.fov * pi / 360);
        half_width_ = half * width_ / std::min(width_, height_);
        half_height_ = half * height_ / std::min(width_, height_);
    } else {
        half_width_ = 0.5 * description.width;
        half_height_ = half_width_ * height_ / width_;
    }
}

CameraRay Camera::ray(const V2d& film, const V2d& lens) const
{
    const double x = (2 * film.x / width_ - 1) * half_width_, y = (1 - 2 * film.y / height_) * half_height_;
    const V3d across = x * right_ + y * up_;
    CameraRay ray{origin_, forward_};
    if (kind_ == CameraKind::perspective)
        ray.d = forward_ + across;
    else
        ray.o += across;
    if (lens_radius_ > 0) {
        const V3d sharp = ray.o + focus_ * ray.d; // d has length 1 along the view: focus_ is the plane's distance
        ray.o += lens_radius_ * (lens.x * right_ + lens.y * up_);
        ray.d = sharp - ray.o;
    }
    ray.d.normalize();
    return ray;
}

Imath::M44d Camera::world_to_camera() const
{
    return {right_.x,
            up_.x,
            -forward_.x,
            0,
            right_.y,
            up_.y,
            -forward_.y,
            0,
            right_.z,
            up_.z,
            -forward_.z,
            0,
            -origin_.dot(right_),
            -origin_.dot(up_),
            origin_.dot(forward_),
            1};
}

Imath::M44d Camera::world_to_ndc() const
{
    // Depth is unchanged: there are no clipping planes.
    const double sx = 1 / half_width_, sy = 1 / half_height_;
    const Imath::M44d projection = kind_ == CameraKind::perspective
                                       ? Imath::M44d(sx, 0, 0, 0, 0, sy, 0, 0, 0, 0, -1, -1, 0, 0, 0, 0)
                                       : Imath::M44d(sx, 0, 0, 0, 0, sy, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
    return world_to_camera() * projection;
}

} // namespace scree
