#include "packing/report/packed_spheres.h"

#include "base/error.h"
#include "base/hash.h"
#include "packing/report/ordered_sum.h"
#include "packing/solids/distance_field.h"
#include "packing/solids/domain.h"
#include "packing/solids/interior_sampler.h"

#include <fmt/format.h>

#include <limits>

namespace scree {

using Imath::V3d;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr uint64_t least_of_a_bed = 64;
constexpr double bulk_depth = 3; // below a mesh's surface, in largest radii

bool along_axes(const SimulationBox& box)
{
    for (size_t k = 0; k < 3; ++k)
        for (int axis = 0; axis < 3; ++axis)
            if (axis != static_cast<int>(k) && box.edges[k][axis] != 0) return false;
    return true;
}

} // namespace

PackedSpheres::PackedSpheres(const ParticleFrame& frame, const std::string& place, const MeshContainer& mesh,
                             const Progress& progress)
    : mesh_(mesh)
{
    take_spheres(frame, place);
    if (!mesh.domain && frame.box && frame.box->volume() > 0) take_box(*frame.box);
    for (size_t k = 0; k < 3; ++k) {
        if (periodic_[k] && largest_ > height_[k])
            throw InputError(place,
                             fmt::format("a sphere of radius {:g} in a periodic box {:g} wide", largest_, height_[k]),
                             "spheres smaller than the box", "are the radii in the box's unit?");
    }
    for (V3d& p : position_) p = wrapped(p);
    for (const V3d& p : position_) bounds_.extendBy(p);
    build_grid();
    if (mesh.domain) {
        container_ = Container::mesh;
        volume_ = mesh.sampler->volume();
    } else if (periodic_[0] && periodic_[1] && periodic_[2]) {
        container_ = Container::periodic_box;
        volume_ = frame.box->volume();
    } else {
        find_bed();
    }
    bulk_.resize(size());
    for_chunks(size(), 1024, "which spheres are in the bulk", progress, [&](uint64_t, uint64_t begin, uint64_t end) {
        for (uint64_t i = begin; i < end; ++i) bulk_[i] = in_bulk(position_[i]);
    });
}

void PackedSpheres::take_spheres(const ParticleFrame& frame, const std::string& place)
{
    double sum[7] = {};
    smallest_ = infinity;
    for (uint64_t i = 0; i < frame.size(); ++i) {
        const double r = frame.radius[i];
        if (!(r > 0)) continue;
        position_.push_back(frame.position[i]);
        radius_.push_back(frame.radius[i]);
        id_.push_back(frame.id[i]);
        smallest_ = std::min(smallest_, r);
        largest_ = std::max(largest_, r);
    }
    left_out_ = frame.size() - size();
    if (frame.size() == 0) throw InputError(place, "no spheres", "a packing of at least one");
    if (size() == 0) throw InputError(place, "spheres without radius only", "radii above 0", "give them with --radius");
    for (const double r : radius_) {
        // Powers of r / largest, so that no unit overflows or vanishes.
        double power = 1;
        for (int k = 1; k <= 6; ++k) sum[k] += power *= r / largest_;
    }
    for (int k = 1; k <= 6; ++k) moments_.m[k] = sum[k] / double(size()) * std::pow(largest_, k);
}

void PackedSpheres::take_box(const SimulationBox& box)
{
    edges_ = box.edges;
    box_lo_ = box.lo;
    for (size_t k = 0; k < 3; ++k) {
        const V3d normal = edges_[(k + 1) % 3].cross(edges_[(k + 2) % 3]);
        to_fraction_[k] = normal / edges_[k].dot(normal);
        height_[k] = box.volume() / normal.length();
        periodic_[k] = box.periodic[k];
    }
    upright_ = along_axes(box);
}

void PackedSpheres::build_grid()
{
    // Searches visit all cells in reach. Where spheres are far apart, cells as wide as a sphere would be mostly empty,
    // so the cells are as wide as the mean distance there: that of the middle half along each axis, since single
    // spheres may be anywhere.
    double volume = 1;
    std::vector<double> values(size());
    for (int axis = 0; axis < 3; ++axis) {
        for (uint64_t i = 0; i < size(); ++i) values[i] = position_[i][axis];
        const auto quarter = values.begin() + static_cast<std::ptrdiff_t>(size() / 4),
                   rest = values.begin() + static_cast<std::ptrdiff_t>(size() - 1 - size() / 4);
        std::nth_element(values.begin(), quarter, values.end());
        const double low = *quarter;
        std::nth_element(values.begin(), rest, values.end());
        volume *= 2 * (*rest - low);
    }
    const float least = static_cast<float>(0.5 * std::cbrt(volume / double(size())));
    std::vector<float> cells = radius_;
    for (float& r : cells) {
        widened_ = widened_ || r < least;
        r = std::max(r, least);
    }
    grid_.emplace(position_, cells);
}

void PackedSpheres::find_bed()
{
    if (size() < least_of_a_bed) return;
    std::vector<double> values(size());
    double volume = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const size_t k = static_cast<size_t>(axis);
        // In a tilted box the bed is limited along every axis.
        if (upright_ && periodic_[k]) {
            bed_.min[axis] = box_lo_[axis];
            bed_.max[axis] = box_lo_[axis] + edges_[k][axis];
            volume *= height_[k];
            continue;
        }
        for (uint64_t i = 0; i < size(); ++i) values[i] = position_[i][axis];
        const auto quartile = [&](uint64_t quarters) {
            const auto nth = values.begin() + static_cast<std::ptrdiff_t>(size() * quarters / 4);
            std::nth_element(values.begin(), nth, values.end());
            return *nth;
        };
        bed_.min[axis] = quartile(1);
        bed_.max[axis] = quartile(3);
        volume *= bed_.max[axis] - bed_.min[axis];
    }
    if (!(volume > 0)) return;
    volume_ = volume;
    container_ = Container::bed;
}

V3d PackedSpheres::wrapped(V3d place) const
{
    for (size_t k = 0; k < 3; ++k)
        if (periodic_[k]) place -= std::floor((place - box_lo_).dot(to_fraction_[k])) * edges_[k];
    return place;
}

V3d PackedSpheres::fractional(const V3d& place) const
{
    V3d result;
    for (size_t k = 0; k < 3; ++k) {
        const int axis = static_cast<int>(k);
        const double extent = bounds_.max[axis] - bounds_.min[axis];
        const double u = periodic_[k] ? (place - box_lo_).dot(to_fraction_[k])
                         : extent > 0 ? (place[axis] - bounds_.min[axis]) / extent
                                      : 0;
        result[axis] = periodic_[k] ? u - std::floor(u) : std::clamp(u, 0.0, 1.0);
    }
    return result;
}

V3d PackedSpheres::sample(uint64_t index, uint64_t seed) const
{
    if (container_ == Container::mesh) return mesh_.sampler->sample(index, seed);
    V3d u;
    for (int axis = 0; axis < 3; ++axis) u[axis] = unit_double(hash_index(index, seed, static_cast<uint64_t>(axis)));
    if (container_ == Container::periodic_box) return box_lo_ + u.x * edges_[0] + u.y * edges_[1] + u.z * edges_[2];
    V3d place;
    for (int axis = 0; axis < 3; ++axis) place[axis] = bed_.min[axis] + u[axis] * (bed_.max[axis] - bed_.min[axis]);
    return place;
}

bool PackedSpheres::in_bulk(const V3d& place, double margin) const
{
    if (container_ == Container::periodic_box) return true;
    if (container_ == Container::none) return false;
    if (container_ == Container::bed) {
        for (int axis = 0; axis < 3; ++axis) {
            if (endless(static_cast<size_t>(axis))) continue;
            if (place[axis] < bed_.min[axis] || place[axis] > bed_.max[axis]) return false;
            if (place[axis] - margin < bounds_.min[axis] || place[axis] + margin > bounds_.max[axis]) return false;
        }
        return true;
    }
    const double least = margin + bulk_depth * largest_;
    const DistanceField::Interval known = mesh_.field->signed_distance(place);
    if (known.lo >= least) return true;
    return known.hi >= least && depth(place) >= least;
}

double PackedSpheres::way_in_bulk(const V3d& place, const V3d& direction, double most) const
{
    if (container_ == Container::periodic_box) return most;
    if (container_ == Container::bed) {
        double way = most;
        for (int axis = 0; axis < 3; ++axis) {
            if (endless(static_cast<size_t>(axis)) || direction[axis] == 0) continue;
            const double face = direction[axis] > 0 ? bed_.max[axis] : bed_.min[axis];
            way = std::min(way, (face - place[axis]) / direction[axis]);
        }
        return std::max(way, 0.0);
    }
    // Steps by a distance that is surely free of the surface, until the end of the bulk is close.
    double way = 0;
    while (way < most) {
        const V3d at = place + way * direction;
        double free = mesh_.field->signed_distance(at).lo - bulk_depth * largest_;
        if (free < 0.05 * largest_) free = depth(at) - bulk_depth * largest_;
        if (free < 0.05 * largest_) return way;
        way += free;
    }
    return most;
}

double PackedSpheres::depth(const V3d& place) const
{
    if (container_ != Container::mesh) return infinity;
    const DistanceField::Interval known = mesh_.field->signed_distance(place);
    const bool inside = known.lo > 0 || (known.hi > 0 && mesh_.domain->contains(place));
    const double distance = mesh_.domain->distance(place);
    return inside ? distance : -distance;
}

bool PackedSpheres::covered(const V3d& place) const
{
    size_t candidates = 0;
    bool hit = false;
    visit_near(place, 0, 1, [&](const Neighbour& n) {
        hit = n.offset.length2() < n.radius * n.radius;
        return !hit && ++candidates < 4096;
    });
    return hit;
}

const SphereGrid::Entry& PackedSpheres::entry(uint64_t rank) const
{
    size_t level = 0;
    while (rank >= grid_->entries(level).size()) rank -= grid_->entries(level++).size();
    return grid_->entries(level)[rank];
}

size_t PackedSpheres::level_of(uint64_t rank) const
{
    size_t level = 0;
    while (rank >= grid_->entries(level).size()) rank -= grid_->entries(level++).size();
    return level;
}

std::vector<uint64_t> PackedSpheres::central_block(uint64_t most, double margin) const
{
    std::vector<uint64_t> block;
    Imath::Box3d extent;
    for (uint64_t i = 0; i < size(); ++i) {
        if (!bulk_[i] || !in_bulk(position_[i], margin)) continue;
        block.push_back(i);
        extent.extendBy(position_[i]);
    }
    if (block.size() <= most) return block;
    const V3d middle = extent.center();
    const auto from = [&](const V3d& centre) {
        return [this, centre](uint64_t i) {
            const V3d d = position_[i] - centre;
            return std::pair(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}), i);
        };
    };
    // The middle of a hollow bulk is not in the bulk: the block grows around the nearest sphere instead.
    const V3d seed = position_[*std::ranges::min_element(block, {}, from(middle))];
    std::ranges::nth_element(block, block.begin() + static_cast<std::ptrdiff_t>(most), {}, from(seed));
    block.resize(most);
    std::ranges::sort(block);
    return block;
}

void PackedSpheres::visit_box(const Imath::Box3d& box, const std::function<void(uint64_t, const V3d&)>& visit) const
{
    const V3d middle = 0.5 * (box.min + box.max);
    const double reach = 0.5 * (box.max - box.min).length(),
                 half = 0.5 * std::max({box.size().x, box.size().y, box.size().z});
    const V3d inside = wrapped(middle), back = middle - inside;
    for (size_t level = 0; level < grid_->level_count(); ++level) {
        visit_images(inside, reach, [&](const V3d& image, int) {
            grid_->visit_near(level, image, half, [&](const SphereGrid::Entry& e) {
                const V3d centre = e.position - image + inside + back;
                if (box.intersects(centre)) visit(e.index, centre);
                return true;
            });
        });
    }
}

} // namespace scree
