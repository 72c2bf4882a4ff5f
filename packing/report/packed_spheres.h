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

/// The solid that a packing is held to fill; all three are of the same mesh and outlive their user.
struct MeshContainer {
    const Domain* domain = nullptr;
    const InteriorSampler* sampler = nullptr;
    const DistanceField* field = nullptr;
};

/// The spheres of a report, what contains them, and who is near whom, periodic images included. Any thread may ask.
///
/// The container is the mesh; else a box that is periodic along all its edges; else the bed, the box between the
/// quartiles of the centres along each axis that is not periodic; else (fewer than 64 spheres) there is none. The
/// *bulk* is the part of it where surfaces do not show: all of a periodic box or bed, and what is three largest radii
/// below a mesh's surface: there also the spheres that touch those of the bulk are whole inside.
class PackedSpheres {
public:
    enum class Container { none, periodic_box, bed, mesh };

    /// Leaves out spheres of radius 0. With a mesh nothing is periodic.
    /// Throws InputError naming `place` when no sphere is left or one is larger than the periodic box, and Cancelled.
    PackedSpheres(const ParticleFrame& frame, const std::string& place, const MeshContainer& mesh = {},
                  const Progress& progress = {});

    uint64_t size() const { return position_.size(); }
    uint64_t left_out() const { return left_out_; }
    const Imath::V3d& position(uint64_t i) const { return position_[i]; } ///< inside the box where it is periodic
    double radius(uint64_t i) const { return radius_[i]; }
    uint64_t id(uint64_t i) const { return id_[i]; }
    bool bulk(uint64_t i) const { return bulk_[i]; } ///< in_bulk of its centre
    const RadiusMoments& moments() const { return moments_; }
    double smallest_radius() const { return smallest_; }
    double largest_radius() const { return largest_; }
    Imath::Box3d bounds() const { return bounds_; } ///< of the centres

    Container container() const { return container_; }
    const MeshContainer& mesh() const { return mesh_; }
    const std::array<Imath::V3d, 3>& edges() const { return edges_; }
    bool periodic(size_t k) const { return periodic_[k]; }
    const Imath::Box3d& bed() const { return bed_; }
    /// Whether the container goes on for ever along an axis of the box.
    bool endless(size_t k) const
    {
        return container_ == Container::periodic_box || (container_ == Container::bed && periodic_[k] && upright_);
    }
    /// Of the container; 0 for none.
    double volume() const { return volume_; }

    /// Uniform in the container; a function of (index, seed).
    Imath::V3d sample(uint64_t index, uint64_t seed) const;
    /// Whether a place is in the bulk and the packing goes on around it for at least `margin` more.
    bool in_bulk(const Imath::V3d& place, double margin = 0) const;
    /// How far a line runs within the bulk from a place there, at most `most`.
    double way_in_bulk(const Imath::V3d& place, const Imath::V3d& direction, double most) const;
    /// Distance from the surface of a mesh, negative outside; infinite in other containers.
    double depth(const Imath::V3d& place) const;
    /// Whether a place is inside any sphere.
    bool covered(const Imath::V3d& place) const;
    /// Coordinates 0..1 along the edges of the periodic box, or in the bounds of the centres.
    Imath::V3d fractional(const Imath::V3d& place) const;

    struct Neighbour {
        uint64_t index;
        double radius;
        Imath::V3d offset; ///< from the place to the (image's) centre
    };

    /// Calls visit(neighbour) for every sphere or image nearer to the place than stretch (add + its radius), and for
    /// some others; stops and returns false when visit returns false.
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

    /// The index of sphere `rank`, from 0, in an order that keeps neighbours together.
    uint64_t ranked(uint64_t rank) const { return entry(rank).index; }

    /// Calls visit(neighbour) for each pair (once), images included, with d < stretch (r_i + r_j) whose first sphere is
    /// ranked(rank); returns false, having left some out, when there are thousands: radii that are wrong.
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
                    // Of two of one level the lower index asks; of two images of itself a sphere asks for one.
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

    /// The spheres of the bulk around which the packing goes on for `margin` more; where they are more than `most`, so
    /// many in a block around their middle. Ascending.
    std::vector<uint64_t> central_block(uint64_t most, double margin) const;

    /// Every sphere or image whose centre lies in a box along the axes: calls visit(index, centre).
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

    /// Calls f(image of the place, side) for the images within reach of what lies in the box; side: 0 for the place
    /// itself, else 1 or -1, of which the opposite image has the other.
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
    bool widened_ = false; ///< radii of the grid's entries are for its cells only
};

} // namespace scree
