#include "packing/solids/surface_tree.h"

#include "base/cgal_messages.h"
#include "ingest/meshes/mesh_topology.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace scree {

namespace {

using Imath::V3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// A triangle as the tree stores it: by value, so that neighbours in the tree are neighbours in memory.
class Face {
public:
    using Id = uint32_t;
    using Point = Kernel::Point_3;
    using Datum = Kernel::Triangle_3;

    Face(uint32_t number, const Corners& corners) : corners_(corners), number_(number) {}
    /// The tree makes its faces with this, from iterators.
    template <class Iterator>
    explicit Face(Iterator face) : Face(*face)
    {
    }

    Id id() const { return number_; }
    Datum datum() const { return {point(0), point(1), point(2)}; }
    Point reference_point() const { return point(0); }
    const Corners& corners() const { return corners_; }

private:
    Point point(size_t k) const { return {corners_[k].x, corners_[k].y, corners_[k].z}; }

    Corners corners_;
    uint32_t number_;
};

using Traits = CGAL::AABB_traits<Kernel, Face>;
using Tree = CGAL::AABB_tree<Traits>;
using Node = CGAL::AABB_node<Traits>;

/// Squared distance from a point to a box, scaled; exact to a few units of 2^-53, except for underflow.
class BoxDistance {
public:
    BoxDistance(const V3d& point, double scale) : point_(point), scale_(scale) {}

    double operator()(const CGAL::Bbox_3& box) const
    {
        return square(gap(box.xmin(), box.xmax(), point_.x), gap(box.ymin(), box.ymax(), point_.y),
                      gap(box.zmin(), box.zmax(), point_.z));
    }
    /// Squared distance to the triangle's box.
    double operator()(const Corners& triangle) const
    {
        const auto& [a, b, c] = triangle;
        const auto along = [&](int k) {
            return gap(std::min(std::min(a[k], b[k]), c[k]), std::max(std::max(a[k], b[k]), c[k]), point_[k]);
        };
        return square(along(0), along(1), along(2));
    }

private:
    static double square(double x, double y, double z) { return x * x + y * y + z * z; }
    double gap(double lo, double hi, double x) const { return std::max(std::max(lo - x, x - hi), 0.0) * scale_; }

    V3d point_;
    double scale_;
};

/// If the squared distance of a box exceeds this, the box is farther than `length`.
double safe_square(double length) { return length * length * (1 + 0x1p-49) + 0x1p-1000; }

/// The question "does a triangle reach into this ball?", as CGAL's tree asks it of its nodes and leaves.
class BallTraversal {
public:
    BallTraversal(const V3d& centre, double radius, double scale)
        : centre_(centre), radius_(radius), scale_(scale), scaled_radius_(radius * scale),
          square_(safe_square(scaled_radius_)), box_distance_(centre, scale)
    {
    }

    bool go_further() const { return !reaches_; }
    bool do_intersect(const V3d&, const Node& node) const { return !(box_distance_(node.bbox()) > square_); }
    void intersection(const V3d&, const Face& face)
    {
        if (box_distance_(face.corners()) > square_) return;
        const DistanceBounds d = bound_distance(centre_, face.corners(), scale_);
        if (d.lo > 0 && d.lo >= scaled_radius_) return;
        if (d.hi < scaled_radius_)
            reaches_ = true;
        else
            reaches_ = is_nearer_exactly(centre_, face.corners(), radius_) || touches_exactly(centre_, face.corners());
    }
    bool reaches() const { return reaches_; }

private:
    V3d centre_;
    double radius_, scale_, scaled_radius_, square_;
    BoxDistance box_distance_;
    bool reaches_ = false;
};

/// The side of the line a to b, seen from above, on which q shifted by (e, e^2) lies, for an arbitrarily small e > 0
/// (simulation of simplicity, Edelsbrunner and Mücke 1990). It is zero only if a is above b, so an upward ray never
/// meets an edge.
template <class K>
CGAL::Sign side_of_edge(const CGAL::Point_3<K>& a, const CGAL::Point_3<K>& b, const CGAL::Point_3<K>& q)
{
    using Flat = CGAL::Point_2<K>;
    const CGAL::Sign side = CGAL::orientation(Flat(a.x(), a.y()), Flat(b.x(), b.y()), Flat(q.x(), q.y()));
    if (side != CGAL::ZERO) return side;
    const CGAL::Sign by_x = CGAL::compare(a.y(), b.y());
    return by_x != CGAL::ZERO ? by_x : CGAL::compare(b.x(), a.x());
}

/// Whether the upward ray from the shifted q meets the triangle.
template <class K>
bool is_above(const CGAL::Point_3<K>& a, const CGAL::Point_3<K>& b, const CGAL::Point_3<K>& c,
              const CGAL::Point_3<K>& q)
{
    const CGAL::Sign side = side_of_edge<K>(a, b, q);
    if (side == CGAL::ZERO || side_of_edge<K>(b, c, q) != side || side_of_edge<K>(c, a, q) != side) return false;
    return CGAL::orientation(a, b, c, q) == -side;
}

template <class K>
CGAL::Point_3<K> point_of(const V3d& p)
{
    return {p.x, p.y, p.z};
}

/// Counts the triangles above a point, which is given with a box around it.
template <class K>
class UpwardTraversal {
public:
    using Point = CGAL::Point_3<K>;

    UpwardTraversal(const Point& point, const CGAL::Bbox_3& box, uint32_t without)
        : point_(point), box_(box), without_(without)
    {
    }

    bool go_further() const { return true; }
    bool do_intersect(const V3d&, const Node& node) const { return may_be_above(node.bbox()); }
    void intersection(const V3d&, const Face& face)
    {
        const auto& [a, b, c] = face.corners();
        const auto [x0, x1] = std::minmax({a.x, b.x, c.x});
        if (x0 > box_.xmax() || x1 < box_.xmin()) return;
        const auto [y0, y1] = std::minmax({a.y, b.y, c.y});
        if (y0 > box_.ymax() || y1 < box_.ymin()) return;
        if (std::max({a.z, b.z, c.z}) < box_.zmin() || face.id() == without_) return;
        odd_ ^= is_above<K>(point_of<K>(a), point_of<K>(b), point_of<K>(c), point_);
    }
    bool odd() const { return odd_; }

private:
    bool may_be_above(const CGAL::Bbox_3& box) const
    {
        return box.xmin() <= box_.xmax() && box.xmax() >= box_.xmin() && box.ymin() <= box_.ymax() &&
               box.ymax() >= box_.ymin() && box.zmax() >= box_.zmin();
    }

    Point point_;
    CGAL::Bbox_3 box_;
    uint32_t without_;
    bool odd_ = false;
};

constexpr uint32_t no_face = std::numeric_limits<uint32_t>::max();

/// Looks for the nearest triangle, nearer nodes first.
class NearestTraversal {
public:
    using Priority = double;

    /// share: triangles are searched within this share of the nearest distance found so far.
    NearestTraversal(const V3d& point, double scale, double share)
        : point_(point), scale_(scale), share_(share), box_distance_(point, scale)
    {
    }

    bool go_further() const { return true; }
    bool do_intersect(const V3d&, const Node& node) const { return !(box_distance_(node.bbox()) > square_); }
    std::pair<bool, double> do_intersect_with_priority(const V3d&, const Node& node) const
    {
        const double square = box_distance_(node.bbox());
        return {!(square > square_), -square};
    }
    void intersection(const V3d&, const Face& face)
    {
        if (box_distance_(face.corners()) > square_) return;
        const DistanceBounds d = bound_distance(point_, face.corners(), scale_);
        nearest_.lo = std::min(nearest_.lo, d.lo);
        if (!(d.hi < nearest_.hi)) return;
        nearest_.hi = d.hi;
        square_ = safe_square(d.hi * share_);
    }
    /// Scaled distance of the nearest triangle.
    DistanceBounds nearest() const { return {std::min(nearest_.lo, nearest_.hi * share_), nearest_.hi}; }

private:
    V3d point_;
    double scale_, share_, square_ = HUGE_VAL;
    BoxDistance box_distance_;
    DistanceBounds nearest_{HUGE_VAL, HUGE_VAL};
};

/// The exact distance to the nearest of the triangles that may be within a (scaled) distance.
class ExactNearestTraversal {
public:
    ExactNearestTraversal(const V3d& point, double scale, double within)
        : point_(point), scale_(scale), within_(within), square_(safe_square(within)), box_distance_(point, scale)
    {
    }

    bool go_further() const { return true; }
    bool do_intersect(const V3d&, const Node& node) const { return !(box_distance_(node.bbox()) > square_); }
    void intersection(const V3d&, const Face& face)
    {
        if (bound_distance(point_, face.corners(), scale_).lo > within_) return;
        nearest_ = std::min(nearest_, distance_exactly(point_, face.corners()));
    }
    double nearest() const { return nearest_; }

private:
    V3d point_;
    double scale_, within_, square_;
    BoxDistance box_distance_;
    double nearest_ = HUGE_VAL;
};

/// Gathers triangles whose boxes are within a distance: their corners or their numbers.
template <class Found>
class NearTraversal {
public:
    NearTraversal(const V3d& point, double scale, double within, std::vector<Found>& found)
        : square_(safe_square(within)), box_distance_(point, scale), found_(found)
    {
    }

    bool go_further() const { return true; }
    bool do_intersect(const V3d&, const Node& node) const { return !(box_distance_(node.bbox()) > square_); }
    void intersection(const V3d&, const Face& face)
    {
        if (box_distance_(face.corners()) > square_) return;
        if constexpr (std::is_same_v<Found, Corners>)
            found_.push_back(face.corners());
        else
            found_.push_back(face.id());
    }

private:
    double square_;
    BoxDistance box_distance_;
    std::vector<Found>& found_;
};

Corners corners_of(const TriangleMesh& mesh, size_t face)
{
    const auto& [a, b, c] = mesh.triangles[face];
    return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

} // namespace

struct SurfaceTree::Impl {
    Tree tree;
    double scale = 1; ///< power of two that scales the bounds' longest edge to 1/2..1
    const TriangleMesh& mesh;

    explicit Impl(const TriangleMesh& m) : mesh(m)
    {
        silence_cgal();
        const Imath::Box3d bounds = bounds_of(mesh);
        // Of halves, so that no difference overflows.
        const V3d half = bounds.max * 0.5 - bounds.min * 0.5;
        const double longest = std::max({half.x, half.y, half.z});
        if (longest > 0) scale = std::ldexp(1.0, std::clamp(-std::ilogb(longest) - 2, -1022, 1022));
        std::vector<Face> faces;
        faces.reserve(mesh.triangles.size());
        for (size_t face = 0; face < mesh.triangles.size(); ++face)
            faces.emplace_back(static_cast<uint32_t>(face), corners_of(mesh, face));
        tree.insert(faces.begin(), faces.end());
        tree.build(); // now, because building it at the first query is not thread-safe
    }
};

SurfaceTree::SurfaceTree(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}

SurfaceTree::~SurfaceTree() = default;

bool SurfaceTree::reaches_into_ball(const V3d& centre, double radius) const
{
    BallTraversal traversal(centre, radius, impl_->scale);
    impl_->tree.traversal(centre, traversal);
    return traversal.reaches();
}

bool SurfaceTree::encloses(const V3d& point) const
{
    const Kernel::Point_3 p(point.x, point.y, point.z);
    UpwardTraversal<Kernel> traversal(p, p.bbox(), no_face);
    impl_->tree.traversal(point, traversal);
    return traversal.odd();
}

std::optional<bool> SurfaceTree::looks_outward(uint32_t face) const
{
    using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;
    const auto [a, b, c] = corners_of(impl_->mesh, face);
    using Flat = Kernel::Point_2;
    const CGAL::Orientation turn = CGAL::orientation(Flat(a.x, a.y), Flat(b.x, b.y), Flat(c.x, c.y));
    if (turn == CGAL::COLLINEAR) return std::nullopt;
    const ExactKernel::Point_3 middle =
        CGAL::centroid(point_of<ExactKernel>(a), point_of<ExactKernel>(b), point_of<ExactKernel>(c));
    UpwardTraversal<ExactKernel> traversal(middle, middle.bbox(), face);
    impl_->tree.traversal(a, traversal);
    // The count is for places just above the face: in front of a face that looks up, behind one that looks down.
    return (turn == CGAL::LEFT_TURN) != traversal.odd();
}

double SurfaceTree::distance(const V3d& point) const
{
    const double scale = impl_->scale;
    NearestTraversal traversal(point, scale, 1);
    impl_->tree.traversal_with_priority(point, traversal);
    const DistanceBounds d = traversal.nearest();
    // The bounds' longest edge is 1/2..1; far outside, the tolerance grows with the distance.
    if (d.hi - d.lo <= 1e-14 * std::max(1.0, d.hi)) return (d.lo / 2 + d.hi / 2) / scale;
    ExactNearestTraversal exact(point, scale, d.hi);
    impl_->tree.traversal(point, exact);
    return exact.nearest();
}

DistanceBounds SurfaceTree::rough_distance(const V3d& point, double slack) const
{
    NearestTraversal traversal(point, impl_->scale, 1 - slack);
    impl_->tree.traversal_with_priority(point, traversal);
    const DistanceBounds d = traversal.nearest();
    return {d.lo / impl_->scale, d.hi / impl_->scale};
}

void SurfaceTree::collect_near(const V3d& point, double distance, std::vector<Corners>& triangles) const
{
    NearTraversal traversal(point, impl_->scale, distance * impl_->scale, triangles);
    impl_->tree.traversal(point, traversal);
}

void SurfaceTree::collect_near(const V3d& point, double distance, std::vector<uint32_t>& faces) const
{
    NearTraversal traversal(point, impl_->scale, distance * impl_->scale, faces);
    impl_->tree.traversal(point, traversal);
}

} // namespace scree
