#include "ingest/meshes/enclosing_sphere.h"

#include <CGAL/Min_sphere_of_points_d_traits_3.h>
#include <CGAL/Min_sphere_of_spheres_d.h>
#include <CGAL/Simple_cartesian.h>

namespace scree {

std::pair<V3d, double> smallest_enclosing_sphere(const std::vector<V3d>& points)
{
    using Kernel = CGAL::Simple_cartesian<double>;
    using Traits = CGAL::Min_sphere_of_points_d_traits_3<Kernel, double>;
    if (points.empty()) return {V3d(0), 0};
    std::vector<Kernel::Point_3> converted;
    converted.reserve(points.size());
    for (const V3d& p : points) converted.emplace_back(p.x, p.y, p.z);
    CGAL::Min_sphere_of_spheres_d<Traits> sphere(converted.begin(), converted.end());
    const auto* c = sphere.center_cartesian_begin();
    const V3d centre(c[0], c[1], c[2]);
    // The radius reaches the farthest point, so that every point is inside despite the solver's rounding.
    double radius2 = 0;
    for (const V3d& p : points) radius2 = std::max(radius2, (p - centre).length2());
    return {centre, std::sqrt(radius2)};
}

} // namespace scree
