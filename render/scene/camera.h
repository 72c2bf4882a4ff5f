#pragma once

#include "base/math.h"

namespace scree {

enum class CameraKind : uint8_t { perspective, orthographic };

/// The camera of the scene file, in the scene's unit.
struct CameraDescription {
    CameraKind kind = CameraKind::perspective;
    V3d origin{0, -1, 0}, target{0}, up{0, 0, 1};
    double fov = 35; ///< perspective: full angle over the shorter side of the picture, degrees
    double width = 1; ///< orthographic: length that the picture's width shows
    double aperture = 0; ///< diameter of the lens; 0 is a pinhole
    double focus = 0; ///< distance of the sharp plane along the view; 0: the target's distance
};

struct CameraRay {
    V3d o, d; ///< unit d
};

/// A camera with a thin lens. Film points are in pixels: (0, 0) is the upper left corner of the picture.
class Camera {
public:
    /// The lengths of `description` are already in render coordinates.
    Camera(const CameraDescription& description, int width, int height);

    /// The ray through a film point; lens is a point of the unit disk.
    CameraRay ray(const V2d& film, const V2d& lens) const;
    /// Distance along the viewing direction.
    double depth(const V3d& point) const { return (point - origin_).dot(forward_); }
    /// Row-vector matrices as OpenEXR stores them: from world to camera space (x right, y up, looking along -z), and
    /// from world to NDC.
    Imath::M44d world_to_camera() const;
    Imath::M44d world_to_ndc() const;

private:
    CameraKind kind_;
    V3d origin_, right_, up_, forward_;
    double half_width_, half_height_; // of the picture at distance 1, or of the orthographic window
    double lens_radius_, focus_;
    double width_, height_;
};

} // namespace scree
