#pragma once

#include "base/progress.h"
#include "ingest/particles/particle_frame.h"
#include "ingest/sphere_grid.h"
#include "packing/report/hard_sphere_fluid.h"

#include <Imath/ImathBox.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace scree {

class DistanceField;
class Domain;
class InteriorSampler;

/// The solid that a packing should fill; all three are of the same mesh and must outlive their user.
struct MeshContainer {
    const Domain* domain = nullptr;
    const InteriorSampler* sampler = nullptr;
    const DistanceField* field = nullptr;
};

/// The spheres of a report, their container, and a search for neighbours, periodic images included. Any thread may ask.
///
/// The container is the mesh; else a box that is periodic along all its edges; else the bed: the box between the
/// quartiles of the centres along each axis that is not periodic; else (fewer than 64 spheres) there is none. The
/// *bulk* is the part of the container away from surfaces: all of a periodic box or bed, or what is at least three
/// largest radii below a mesh's surface. At that depth, spheres that touch a sphere of the bulk are also wholly inside
/// the mesh.
class PackedSpheres {
public:
    enum class Container { none, periodic_box, bed, mesh };

    /// Leaves out spheres of radius 0. With a mesh, nothing is periodic.
    /// Throws InputError naming `place` when no sphere is left or one is larger than the periodic box, and Cancelled.
    PackedSpheres(const ParticleFrame& frame, const std::string& place, const MeshContainer& mesh = {},
                  const Progress& progress = {});

    uint64_t size() const { return position_.size(); }
    uint64_t left_out() const { return left_out_; }
    const Imath::V3d& position(uint64_t i) const { return position_[i]; } ///< inside the box where it is periodic
    double radius(uint64_t i) const { return radius_[i]; }
    uint64_t id(uint64_t i) const { return id_[i]; }
    bool bulk(uint64_t i) const { return bulk_[i]; } ///< whether the sphere's centre is in the bulk
    const RadiusMoments& moments() const { return moments_; }
    double smallest_radius() const { return smallest_; }
    double largest_radius() const { return largest_; }
    Imath::Box3d bounds() const { return bounds_; } ///< of the centres

    Container container() const { return container_; }
    const MeshContainer& mesh() const { return mesh_; }
    const std::array<Imath::V3d, 3>& edges() const { return edges_; }
    bool periodic(size_t k) const { return periodic_[k]; }
    const Imath::Box3d& bed() const { return bed_; }
    /// Whether the container has no end along an axis of the box.
    bool endless(size_t k) const
    {
        return container_ == Container::periodic_box || (container_ == Container::bed && periodic_[k] && upright_);
    }
    /// Volume of the container; 0 if there is none.
    double volume() const { return volume_; }

    /// A place uniform in the container; depends only on (index, seed).
    Imath::V3d sample(uint64_t index, uint64_t seed) const;
    /// Whether a place is in the bulk and the packing extends for at least `margin` more around it.
    bool in_bulk(const Imath::V3d& place, double margin = 0) const;
    /// The distance along a line from a place in the bulk to the end of the bulk, at most `most`.
    double way_in_bulk(const Imath::V3d& place, const Imath::V3d& direction, double most) const;
    /// Signed distance from a mesh's surface, negative outside; infinite in other containers.
    double depth(const Imath::V3d& place) const;
    /// Whether a place is inside any sphere.
    bool covered(const Imath::V3d& place) const;
    /// Coordinates 0..1 along the edges of the periodic box, or in the bounds of the centres.
    Imath::V3d fractional(const Imath::V3d& place) const;

    struct Neighbour {
        uint64_t index;
        double radius;
        Imath::V3d offset; ///< from the place to the centre of the sphere or image
    };

    /// Calls visit(neighbour) for every sphere or image nearer to the place than stretch * (add + its radius), and for
    /// some others. Stops and returns false when visit returns false.
    template <class Visit>
    bool visit_near(const Imath::V3d& place, double add, double stretch, const Visit& visit) const
    {
        const Imath::V3d inside = wrapped(place);
        bool going = true;
        for (size_t level = 0; level < grid_->level_count() && going; ++level) {
            const double reach = stretch * (add + grid_->level_radius(level));
            visit_images(inside, reach, [&](const Imath::V3d& image, int) {
                going = going && grid_->visit_near(level, image, reach, [&](const SphereGrid::Entry& e) {
                    return visit(Neighbour{e.index, radius_of(e), e.position - image});
                });
            });
        }
        return going;
    }

    /// The index of the sphere at a rank, counted from 0, in an order that keeps neighbours together.
    uint64_t ranked(uint64_t rank) const { return entry(rank).index; }

    /// Calls visit(neighbour) once for each pair, images included, with d < stretch * (r_i + r_j) whose first sphere is
    /// ranked(rank). Returns false, with some pairs left out, if there are thousands: the radii must be wrong.
    template <class Visit>
    bool visit_pairs(uint64_t rank, double stretch, const Visit& visit) const
    {
        const SphereGrid::Entry& self = entry(rank);
        size_t candidates = 0;
        bool complete = true;
        const size_t own = level_of(rank);
        for (size_t level = own; level < grid_->level_count(); ++level) {
            const double reach = stretch * (radius_of(self) + grid_->level_radius(level));
            visit_images(self.position, reach, [&](const Imath::V3d& image, int side) {
                complete = complete && grid_->visit_near(level, image, reach, [&](const SphereGrid::Entry& e) {
                    if (++candidates > 4096) return false;
                    // Count each pair once: in one level from the lower index; a sphere with its own image, on one
                    // side.
                    if (level == own && (e.index < self.index || (e.index == self.index && side <= 0))) return true;
                    const Imath::V3d offset = e.position - image;
                    const double radius = radius_of(e), touch = stretch * (radius_of(self) + radius);
                    if (offset.length2() < touch * touch) visit(Neighbour{e.index, radius, offset});
                    return true;
                });
            });
        }
        return complete;
    }

    /// The bulk spheres around which the packing extends for `margin` more; if there are more than `most`, that many in
    /// a block around their middle. Ascending.
    std::vector<uint64_t> central_block(uint64_t most, double margin) const;

    /// Calls visit(index, centre) for every sphere or image whose centre lies in an axis-aligned box.
    void visit_box(const Imath::Box3d& box, const std::function<void(uint64_t, const Imath::V3d&)>& visit) const;

private:
    void take_spheres(const ParticleFrame& frame, const std::string& place);
    void take_box(const SimulationBox& box);
    void find_bed();
    void build_grid();
    const SphereGrid::Entry& entry(uint64_t rank) const;
    double radius_of(const SphereGrid::Entry& e) const
    {
        return widened_ ? double(radius_[e.index]) : double(e.radius);
    }
    Imath::V3d wrapped(Imath::V3d place) const;
    size_t level_of(uint64_t rank) const;

    /// Calls f(image, side) for every image of the place that is within `reach` of the box. side: 0 for the place
    /// itself, else 1 or -1; opposite images have opposite sides.
    template <class F>
    void visit_images(const Imath::V3d& inside, double reach, const F& f) const
    {
        int lo[3] = {0, 0, 0}, hi[3] = {0, 0, 0};
        for (size_t k = 0; k < 3; ++k) {
            if (!periodic_[k]) continue;
            const double depth = (inside - box_lo_).dot(to_fraction_[k]) * height_[k];
            lo[k] = static_cast<int>(std::ceil((-reach - depth) / height_[k]));
            hi[k] = static_cast<int>(std::floor((height_[k] + reach - depth) / height_[k]));
        }
        for (int c = lo[2]; c <= hi[2]; ++c)
            for (int b = lo[1]; b <= hi[1]; ++b)
                for (int a = lo[0]; a <= hi[0]; ++a) {
                    const int first = c != 0 ? c : b != 0 ? b : a;
                    f(inside + double(a) * edges_[0] + double(b) * edges_[1] + double(c) * edges_[2], first > 0   ? 1
                                                                                                      : first < 0 ? -1
                                                                                                                  : 0);
                }
    }

    std::vector<Imath::V3d> position_;
    std::vector<float> radius_;
    std::vector<uint64_t> id_;
    std::vector<uint8_t> bulk_;
    uint64_t left_out_ = 0;
    RadiusMoments moments_;
    double smallest_ = 0, largest_ = 0;
    Imath::Box3d bounds_, bed_;
    MeshContainer mesh_;
    Container container_ = Container::none;
    double volume_ = 0;
    std::array<bool, 3> periodic_{false, false, false};
    bool upright_ = false; ///< the box's edges lie along the axes
    std::array<Imath::V3d, 3> edges_{Imath::V3d(0), Imath::V3d(0), Imath::V3d(0)}, to_fraction_ = edges_;
    std::array<double, 3> height_{0, 0, 0};
    Imath::V3d box_lo_{0};
    std::optional<SphereGrid> grid_;
    bool widened_ = false; ///< the grid's entries have enlarged radii, which serve only to size its cells
};

} // namespace scree
