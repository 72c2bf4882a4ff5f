#include "packing/tiles/tile_relaxation.h"

#include "base/error.h"
#include "packing/tiles/tile_cells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

namespace scree {

namespace {

// Sums over fixed blocks, added in the order of the blocks, are the same for any number of threads.
constexpr uint64_t block = 256, chunk = 32;
constexpr uint32_t body_bits = 27;
constexpr uint32_t body_mask = (1u << body_bits) - 1;

// FIRE's parameters as published; times in units of (mass / spring)^(1/2), which are pure numbers here.
constexpr double first_dt = 0.1, shortest_dt = 0.01, longest_dt = 0.45;
constexpr double first_alpha = 0.1, alpha_shrinks = 0.99, dt_grows = 1.1, dt_shrinks = 0.5;
constexpr int patience = 5;

// Lists hold pairs nearer than the sum of radii plus this part of the mean radius: small if spheres move little.
constexpr double widest_skin = 0.4, narrowest_skin = 0.04;

/// Interleaves the bits of three 10-bit numbers: places near each other get numbers near each other.
uint32_t morton(const Imath::V3d& place, const Imath::V3d& size)
{
    uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto cell = static_cast<uint32_t>(std::clamp(place[axis] / size[axis] * 1024, 0.0, 1023.0));
        for (uint32_t bit = 0; bit < 10; ++bit) code |= (cell >> bit & 1) << (3 * bit + static_cast<uint32_t>(axis));
    }
    return code;
}

} // namespace

struct TileRelaxation::Sheet {
    std::vector<uint32_t> members; ///< bodies
    std::vector<Imath::V3d> place;
    std::unique_ptr<TileCells> cells;
};

struct TileRelaxation::Sums {
    double power = 0, force2 = 0, velocity2 = 0;
    double overlap_lengths = 0, worst = 0;
    uint64_t contacts = 0;

    void add(const Sums& other)
    {
        power += other.power;
        force2 += other.force2;
        velocity2 += other.velocity2;
        overlap_lengths += other.overlap_lengths;
        worst = std::max(worst, other.worst);
        contacts += other.contacts;
    }
};

TileRelaxation::TileRelaxation(const TileSpheres& spheres)
    : size_(spheres.size), mean_radius_(spheres.mean_radius()), skin_(widest_skin * mean_radius_), row_(spheres.count())
{
    std::vector<uint32_t> code(spheres.count());
    for (size_t i = 0; i < code.size(); ++i) code[i] = morton(spheres.place[i], size_);
    std::iota(row_.begin(), row_.end(), 0u);
    std::sort(row_.begin(), row_.end(),
              [&](uint32_t a, uint32_t b) { return code[a] != code[b] ? code[a] < code[b] : a < b; });
    uint32_t sheets = 1;
    for (const uint32_t row : row_) {
        const Imath::V3d& p = spheres.place[row];
        body_.push_back({p.x, p.y, p.z, spheres.radius[row]});
        sheet_.push_back(spheres.sheet_of(row));
        sheets = std::max(sheets, sheet_.back());
    }
    velocity_.resize(body_.size());
    force_.resize(body_.size());
    listed_.resize(body_.size());
    inverse_mass_.resize(body_.size());
    // A large sphere has contacts in proportion to its surface, and a sphere of sheet 0 has contacts in every sheet.
    // Masses in proportion to the contacts give all modes similar speeds.
    for (size_t b = 0; b < body_.size(); ++b) {
        const double surface = std::max(1.0, std::pow(body_[b].r / mean_radius_, 2));
        inverse_mass_[b] = 1 / (surface * (sheet_[b] == 0 ? (1.0 + sheets) / 2 : 1.0));
    }
    for (int s = 0; s < 27; ++s)
        shifts_[static_cast<size_t>(s)] = {(s % 3 - 1) * size_.x, (s / 3 % 3 - 1) * size_.y, (s / 9 - 1) * size_.z, 0};
}

std::vector<Imath::V3d> TileRelaxation::places() const
{
    std::vector<Imath::V3d> places(body_.size());
    for (size_t b = 0; b < body_.size(); ++b)
        places[row_[b]] = wrapped_into({body_[b].x, body_[b].y, body_[b].z}, size_);
    return places;
}

/// The bodies of each sheet with cells of their own, so that a body never looks at sheets that it does not meet.
std::vector<TileRelaxation::Sheet> TileRelaxation::sheets_of(const std::vector<double>& radius,
                                                             const std::vector<Imath::V3d>& place) const
{
    std::vector<Sheet> sheets(1 + *std::ranges::max_element(sheet_));
    std::vector<std::vector<double>> radii(sheets.size());
    for (uint32_t b = 0; b < body_.size(); ++b) {
        Sheet& sheet = sheets[sheet_[b]];
        sheet.members.push_back(b);
        sheet.place.push_back(place[b]);
        radii[sheet_[b]].push_back(radius[b]);
    }
    for (size_t k = 0; k < sheets.size(); ++k) {
        sheets[k].cells = std::make_unique<TileCells>(size_, radii[k], skin_);
        sheets[k].cells->fill(sheets[k].place);
    }
    return sheets;
}

void TileRelaxation::build_lists(double scale)
{
    std::vector<double> radius(body_.size());
    std::vector<Imath::V3d> place(body_.size());
    for (size_t b = 0; b < body_.size(); ++b) {
        Body& body = body_[b];
        radius[b] = scale * body.r;
        place[b] = {body.x, body.y, body.z};
        // A sphere pushed through a wall must not come back on the other side.
        if (sheet_[b] > 0)
            for (int axis = 0; axis < 3; ++axis)
                place[b][axis] = std::clamp(place[b][axis], 0.0, std::nextafter(size_[axis], 0.0));
        else
            place[b] = wrapped_into(place[b], size_);
        body.x = place[b].x, body.y = place[b].y, body.z = place[b].z;
    }
    const double widest = 2 * *std::ranges::max_element(radius) + skin_;
    if (widest > std::min({size_.x, size_.y, size_.z})) // an image's shift is one edge at most
        throw InputError("tile", "spheres as wide as the cuboid",
                         "a cuboid whose edges are well above the largest diameter",
                         "more spheres, or a narrower range of radii");
    const std::vector<Sheet> sheets = sheets_of(radius, place);
    const uint64_t blocks = (body_.size() + block - 1) / block;
    std::vector<std::vector<uint32_t>> found(blocks);
    starts_.assign(body_.size() + 1, 0);
    tbb::parallel_for(uint64_t{0}, blocks, [&](uint64_t part) {
        std::vector<uint32_t>& out = found[part];
        const auto look = [&](uint64_t b, const Sheet& sheet) {
            for (size_t level = 0; level < sheet.cells->level_count(); ++level)
                sheet.cells->visit_near(
                    level, place[b], radius[b] + sheet.cells->level_radius(level) + skin_,
                    [&](uint32_t member, int x, int y, int z) {
                        const uint32_t c = sheet.members[member];
                        if (c == b) return true; // its own images move with it and do not push it
                        const Imath::V3d d =
                            sheet.place[member] + Imath::V3d(x * size_.x, y * size_.y, z * size_.z) - place[b];
                        const double reach = radius[b] + radius[c] + skin_;
                        if (d.length2() < reach * reach)
                            out.push_back(c | static_cast<uint32_t>((x + 1) + 3 * (y + 1) + 9 * (z + 1)) << body_bits);
                        return true;
                    });
        };
        for (uint64_t b = part * block; b < std::min<uint64_t>(body_.size(), (part + 1) * block); ++b) {
            const size_t before = out.size();
            if (sheet_[b] == 0)
                for (const Sheet& sheet : sheets) look(b, sheet);
            else
                for (const uint32_t sheet : {0u, sheet_[b]}) look(b, sheets[sheet]);
            starts_[b + 1] = out.size() - before;
        }
    });
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    neighbours_.resize(starts_.back());
    tbb::parallel_for(uint64_t{0}, blocks, [&](uint64_t part) {
        std::ranges::copy(found[part], neighbours_.begin() + static_cast<int64_t>(starts_[part * block]));
    });
    for (size_t b = 0; b < body_.size(); ++b) listed_[b] = {body_[b].x, body_[b].y, body_[b].z};
}

TileRelaxation::Sums TileRelaxation::add_forces(double scale, uint64_t begin, uint64_t end)
{
    // Passes over arrays, which compilers vectorise: find near bodies, compute overlaps, add up.
    thread_local std::vector<Body> apart;
    thread_local std::vector<double> overlap, push;
    const uint64_t first = starts_[begin], pairs = starts_[end] - first;
    if (overlap.size() < pairs) {
        apart.resize(pairs);
        overlap.resize(pairs), push.resize(pairs);
    }
    for (uint64_t k = begin; k < end; ++k) {
        const Body& b = body_[k];
        for (uint64_t n = starts_[k]; n < starts_[k + 1]; ++n) {
            const Body& c = body_[neighbours_[n] & body_mask];
            const Body& shift = shifts_[neighbours_[n] >> body_bits];
            apart[n - first] = {c.x + shift.x - b.x, c.y + shift.y - b.y, c.z + shift.z - b.z, c.r + b.r};
        }
    }
    for (uint64_t n = 0; n < pairs; ++n) {
        const Body& a = apart[n];
        const double sum = scale * a.r, d = std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z), h = std::max(sum - d, 0.0);
        overlap[n] = h;
        // Spheres at exactly the same place do not push each other; rounding separates them.
        push[n] = h / std::max(d, 1e-9 * sum);
    }
    Sums sums;
    for (uint64_t k = begin; k < end; ++k) {
        Vector f;
        for (uint64_t n = starts_[k] - first; n < starts_[k + 1] - first; ++n) {
            const Body& a = apart[n];
            f.x -= push[n] * a.x, f.y -= push[n] * a.y, f.z -= push[n] * a.z;
            const double h = overlap[n], sum = scale * a.r;
            sums.overlap_lengths += h;
            sums.contacts += h > 0;
            if (h > sums.worst * sum) sums.worst = h / sum;
        }
        if (sheet_[k] > 0) push_off_walls(scale, k, f, sums);
        force_[k] = f;
        const Vector& v = velocity_[k];
        sums.power += f.x * v.x + f.y * v.y + f.z * v.z;
        sums.force2 += f.x * f.x + f.y * f.y + f.z * f.z;
        sums.velocity2 += v.x * v.x + v.y * v.y + v.z * v.z;
    }
    return sums;
}

void TileRelaxation::push_off_walls(double scale, uint64_t body, Vector& force, Sums& sums) const
{
    const Body& b = body_[body];
    const double r = scale * b.r;
    const auto push = [&](double depth, double& component, double direction) {
        const double h = r - depth;
        if (h <= 0) return;
        component += direction * h;
        sums.overlap_lengths += h;
        sums.worst = std::max(sums.worst, h / r);
        ++sums.contacts;
    };
    push(b.x, force.x, 1), push(size_.x - b.x, force.x, -1);
    push(b.y, force.y, 1), push(size_.y - b.y, force.y, -1);
    push(b.z, force.z, 1), push(size_.z - b.z, force.z, -1);
}

TileRelaxation::Sums TileRelaxation::all_forces(double scale)
{
    const uint64_t count = body_.size(), blocks = (count + block - 1) / block;
    std::vector<Sums> parts(blocks);
    tbb::parallel_for(uint64_t{0}, blocks, [&](uint64_t part) { // The pairs of a chunk fit into the nearest cache.
        for (uint64_t k = part * block; k < std::min(count, (part + 1) * block); k += chunk)
            parts[part].add(add_forces(scale, k, std::min(count, k + chunk)));
    });
    Sums sums;
    for (const Sums& part : parts) sums.add(part);
    return sums;
}

/// Sets v <- keep v + along F, accelerates (semi-implicit Euler), and moves each body by at most `limit`. Returns the
/// greatest squared distance of a body from its place when the lists were built.
double TileRelaxation::advance(double dt, double keep, double along, double limit)
{
    const uint64_t count = body_.size(), blocks = (count + block - 1) / block;
    std::vector<double> farthest(blocks, 0);
    tbb::parallel_for(uint64_t{0}, blocks, [&](uint64_t part) {
        for (uint64_t k = part * block; k < std::min(count, (part + 1) * block); ++k) {
            Vector& v = velocity_[k];
            const Vector& f = force_[k];
            const double a = along + dt * inverse_mass_[k];
            v.x = keep * v.x + a * f.x, v.y = keep * v.y + a * f.y, v.z = keep * v.z + a * f.z;
            const double step2 = dt * dt * (v.x * v.x + v.y * v.y + v.z * v.z);
            const double cut = step2 > limit * limit ? dt * limit / std::sqrt(step2) : dt;
            Body& b = body_[k];
            b.x += cut * v.x, b.y += cut * v.y, b.z += cut * v.z;
            const double dx = b.x - listed_[k].x, dy = b.y - listed_[k].y, dz = b.z - listed_[k].z;
            farthest[part] = std::max(farthest[part], dx * dx + dy * dy + dz * dz);
        }
    });
    return farthest.empty() ? 0 : *std::ranges::max_element(farthest);
}

TileRelaxation::Outcome TileRelaxation::relax(double scale, const Goal& goal, const Progress& progress)
{
    std::ranges::fill(velocity_, Vector{});
    skin_ = mean_radius_ *
            (state_.steps == 0 ? widest_skin : std::clamp(20 * state_.mean_overlap, narrowest_skin, widest_skin));
    build_lists(scale);
    uint64_t built = 0;
    double dt = first_dt, alpha = first_alpha;
    int downhill = 0;
    for (uint64_t step = 0; step < goal.max_steps; ++step, ++state_.steps) {
        if (step % 16 == 0 && progress.cancelled()) throw Cancelled();
        const Sums sums = all_forces(scale);
        state_.worst_overlap = sums.worst;
        state_.contacts = sums.contacts;
        const double mean_force = sums.contacts > 0 ? sums.overlap_lengths / static_cast<double>(sums.contacts) : 0;
        state_.mean_overlap = mean_force / (2 * scale * mean_radius_);
        if (sums.worst <= goal.allowed) return Outcome::separated;
        if (std::sqrt(sums.force2 / static_cast<double>(body_.size())) < goal.balance * mean_force)
            return Outcome::balanced;

        double keep = 1, along = 0;
        if (sums.power > 0) {
            if (sums.force2 > 0) {
                keep = 1 - alpha;
                along = alpha * std::sqrt(sums.velocity2 / sums.force2);
            }
            if (++downhill > patience) {
                dt = std::min(dt * dt_grows, longest_dt);
                alpha *= alpha_shrinks;
            }
        } else if (step > 0) {
            downhill = 0;
            dt = std::max(dt * dt_shrinks, shortest_dt);
            alpha = first_alpha;
            keep = 0;
        }
        const double moved2 = advance(dt, keep, along, 0.2 * mean_radius_);
        if (4 * moved2 <= skin_ * skin_) continue;
        if (step < built + 30) skin_ = std::min(2 * skin_, widest_skin * mean_radius_);
        build_lists(scale);
        built = step;
    }
    return Outcome::unfinished;
}

} // namespace scree
