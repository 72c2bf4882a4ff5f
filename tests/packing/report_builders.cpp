#include "tests/packing/report_builders.h"

#include "base/hash.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace scree::test {

using Imath::V3d;

namespace {

/// The cells of a periodic cube, each with its spheres, for Metropolis moves of single spheres.
class MoveCells {
public:
    MoveCells(const std::vector<V3d>& positions, double edge, double reach)
        : edge_(edge), n_(static_cast<int>(edge / reach)), cells_(static_cast<size_t>(n_ * n_ * n_))
    {
        for (size_t i = 0; i < positions.size(); ++i) cells_[of(positions[i])].push_back(i);
    }

    void move(size_t i, const V3d& from, const V3d& to)
    {
        const size_t a = of(from), b = of(to);
        if (a == b) return;
        auto& old = cells_[a];
        old.erase(std::ranges::find(old, i));
        cells_[b].push_back(i);
    }

    /// Whether a sphere of radius r at `place` overlaps none of the spheres except i.
    bool free(size_t i, const V3d& place, double r, const std::vector<V3d>& positions,
              const std::vector<float>& radii) const
    {
        int c[3];
        for (int axis = 0; axis < 3; ++axis) c[axis] = coordinate(place[axis]);
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x)
                    for (const size_t j : cells_[index(c[0] + x, c[1] + y, c[2] + z)]) {
                        if (j == i) continue;
                        V3d d = positions[j] - place;
                        for (int axis = 0; axis < 3; ++axis) d[axis] -= edge_ * std::round(d[axis] / edge_);
                        const double touch = r + double(radii[j]);
                        if (d.length2() < touch * touch) return false;
                    }
        return true;
    }

private:
    int coordinate(double x) const { return std::min(static_cast<int>(x / edge_ * n_), n_ - 1); }
    size_t index(int x, int y, int z) const
    {
        return static_cast<size_t>((((z + n_) % n_) * n_ + (y + n_) % n_) * n_ + (x + n_) % n_);
    }
    size_t of(const V3d& p) const { return index(coordinate(p.x), coordinate(p.y), coordinate(p.z)); }

    double edge_;
    int n_;
    std::vector<std::vector<size_t>> cells_;
};

} // namespace

ParticleFrame periodic_frame(std::vector<V3d> positions, std::vector<float> radii, const V3d& box)
{
    ParticleFrame frame;
    frame.position = std::move(positions);
    frame.radius = std::move(radii);
    frame.type.assign(frame.size(), 1);
    for (uint64_t i = 0; i < frame.size(); ++i) frame.id.push_back(i + 1);
    frame.has_ids = true;
    SimulationBox cell;
    cell.edges = {V3d(box.x, 0, 0), V3d(0, box.y, 0), V3d(0, 0, box.z)};
    cell.periodic = {true, true, true};
    frame.box = cell;
    frame.origin = box / 2;
    return frame;
}

ParticleFrame lattice(const std::string& kind, int cells, float radius)
{
    std::vector<V3d> basis{V3d(0)};
    V3d cell(1);
    if (kind == "bcc") {
        cell = V3d(2 / std::sqrt(3.0));
        basis.push_back(0.5 * cell);
    } else if (kind == "fcc") {
        cell = V3d(std::sqrt(2.0));
        for (const V3d& half : {V3d(0, 0.5, 0.5), V3d(0.5, 0, 0.5), V3d(0.5, 0.5, 0)}) basis.push_back(half * cell);
    } else if (kind == "hcp") {
        cell = {1, std::sqrt(3.0), std::sqrt(8.0 / 3)};
        for (const V3d& part : {V3d(0.5, 0.5, 0), V3d(0.5, 1.0 / 6, 0.5), V3d(0, 2.0 / 3, 0.5)})
            basis.push_back(part * cell);
    } else if (kind != "sc") {
        throw std::invalid_argument(kind);
    }
    std::vector<V3d> positions;
    for (int z = 0; z < cells; ++z)
        for (int y = 0; y < cells; ++y)
            for (int x = 0; x < cells; ++x)
                for (const V3d& b : basis) positions.push_back(b + V3d(x, y, z) * cell);
    const size_t count = positions.size();
    return periodic_frame(std::move(positions), std::vector<float>(count, radius), cell * double(cells));
}

ParticleFrame hard_sphere_fluid(int cells, double fraction, int sweeps, uint64_t seed,
                                const std::vector<double>& diameters)
{
    std::vector<V3d> positions = lattice("fcc", cells).position;
    const size_t n = positions.size();
    std::vector<float> radii(n);
    double volume = 0, largest = 0;
    for (size_t i = 0; i < n; ++i) {
        radii[i] = static_cast<float>(0.5 * diameters[hash_index(i, seed, 1) % diameters.size()]);
        const double r = radii[i];
        volume += 4.0 / 3 * std::numbers::pi * r * r * r;
        largest = std::max(largest, r);
    }
    const double edge = std::cbrt(volume / fraction), stretch = edge / (std::sqrt(2.0) * cells);
    if (stretch < 2 * largest) throw std::invalid_argument("no room for the lattice to start from");
    for (V3d& p : positions) p *= stretch;
    MoveCells grid(positions, edge, 2 * largest);
    const double step = 0.3 * (edge / std::cbrt(double(n)) / largest - 1) * largest + 0.05 * largest;
    uint64_t draws = 0;
    const auto random = [&] { return unit_double(hash_index(draws++, seed, 2)); };
    for (uint64_t move = 0; move < static_cast<uint64_t>(sweeps) * n; ++move) {
        const size_t i = static_cast<size_t>(random() * double(n));
        V3d to = positions[i];
        for (int axis = 0; axis < 3; ++axis) {
            to[axis] += step * (2 * random() - 1);
            to[axis] -= edge * std::floor(to[axis] / edge);
        }
        if (!grid.free(i, to, radii[i], positions, radii)) continue;
        grid.move(i, positions[i], to);
        positions[i] = to;
    }
    return periodic_frame(std::move(positions), std::move(radii), V3d(edge));
}

ParticleFrame scaled(ParticleFrame frame, double factor)
{
    for (V3d& p : frame.position) p *= factor;
    for (float& r : frame.radius) r *= static_cast<float>(factor);
    frame.origin *= factor;
    if (frame.box) {
        frame.box->lo *= factor;
        for (V3d& e : frame.box->edges) e *= factor;
    }
    return frame;
}

ParticleFrame without_box(ParticleFrame frame)
{
    frame.box.reset();
    return frame;
}

} // namespace scree::test
