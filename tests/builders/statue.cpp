// The zero set of a signed distance (up to a factor), drawn by marching tetrahedra (Doi and Koide 1991): each cube is
// six tetrahedra along its diagonal.

#include "tests/builders/statue.h"

#include "base/math.h"

#include <unordered_map>

namespace scree {

namespace {

double smooth_min(double a, double b, double width)
{
    const double h = std::max(width - std::abs(a - b), 0.0) / width;
    return std::min(a, b) - 0.25 * h * h * width;
}

/// Distance from a bar that is ra thick at a and rb at b.
double bar(const V3d& p, const V3d& a, const V3d& b, double ra, double rb)
{
    const double h = std::clamp((p - a).dot(b - a) / (b - a).length2(), 0.0, 1.0);
    return (p - a - h * (b - a)).length() - (ra + h * (rb - ra));
}

double block(const V3d& p, const V3d& middle, const V3d& half, double rounding)
{
    const V3d q(std::abs(p.x - middle.x) - half.x + rounding, std::abs(p.y - middle.y) - half.y + rounding,
                std::abs(p.z - middle.z) - half.z + rounding);
    const V3d out(std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0));
    return out.length() + std::min(std::max({q.x, q.y, q.z}), 0.0) - rounding;
}

double figure(const V3d& p)
{
    const double around = std::atan2(p.y, p.x);
    const double folds = 0.008 * std::sin(17 * around + 9 * p.z) * std::clamp((0.5 - p.z) / 0.3, 0.0, 1.0);
    double d = bar(p, {0, 0, 0.18}, {0, 0, 0.5}, 0.14, 0.085) + folds;
    d = smooth_min(d, bar(p, {-0.05, 0, 0.66}, {0.05, 0, 0.66}, 0.085, 0.085), 0.08);
    d = smooth_min(d, bar(p, {0, 0, 0.7}, {0, -0.01, 0.82}, 0.04, 0.035), 0.03);
    const V3d head = p - V3d(0, -0.01, 0.89);
    d = smooth_min(d, (V3d(head.x / 0.85, head.y, head.z / 1.15).length() - 0.085) * 0.85, 0.02);
    d = smooth_min(d, bar(p, {0, -0.09, 0.88}, {0, -0.1, 0.865}, 0.008, 0.012), 0.01); // nose
    for (const double side : {-1.0, 1.0}) {
        const V3d shoulder(side * 0.11, 0, 0.69), elbow(side * 0.2, 0.02, 0.54),
            hand(side * 0.1, -0.15, 0.56 + 0.06 * side);
        d = smooth_min(d, bar(p, shoulder, elbow, 0.045, 0.035), 0.03);
        d = smooth_min(d, bar(p, elbow, hand, 0.035, 0.022), 0.02);
        for (int finger = -1; finger <= 1; ++finger)
            d = smooth_min(d, bar(p, hand, hand + V3d(-0.02 * side, -0.04, 0.016 * finger), 0.01, 0.007), 0.008);
    }
    d = smooth_min(d, block(p, {0, 0, 0.05}, {0.2, 0.18, 0.04}, 0.01), 0.02);
    const double wave = 100 * pi; // half a wave is a hundredth of the height
    return d + 0.002 * std::sin(wave * p.x) * std::sin(wave * p.y + 1) * std::sin(wave * p.z + 2);
}

class Marcher {
public:
    Marcher(const V3d& lo, const V3d& hi, double cell) : lo_(lo), cell_(cell)
    {
        for (int k = 0; k < 3; ++k)
            count_[static_cast<size_t>(k)] = static_cast<uint64_t>(std::ceil((hi[k] - lo[k]) / cell)) + 1;
        for (uint64_t i = 0; i < count_[0] * count_[1] * count_[2]; ++i) values_.push_back(figure(place(i)));
    }

    TriangleMesh run()
    {
        static constexpr std::array<std::array<uint64_t, 2>, 6> ways{
            {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}}}; // corners, bits x y z, from 0 to 7
        for (uint64_t x = 0; x + 1 < count_[0]; ++x)
            for (uint64_t y = 0; y + 1 < count_[1]; ++y)
                for (uint64_t z = 0; z + 1 < count_[2]; ++z) {
                    const auto corner = [&](uint64_t bits) {
                        return number(x + (bits & 1), y + (bits >> 1 & 1), z + (bits >> 2));
                    };
                    for (const auto& way : ways) cut({corner(0), corner(way[0]), corner(way[1]), corner(7)});
                }
        return std::move(mesh_);
    }

private:
    uint64_t number(uint64_t x, uint64_t y, uint64_t z) const { return (x * count_[1] + y) * count_[2] + z; }
    V3d place(uint64_t i) const
    {
        const uint64_t z = i % count_[2], y = i / count_[2] % count_[1], x = i / count_[2] / count_[1];
        return lo_ + cell_ * V3d(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
    }

    void cut(const std::array<uint64_t, 4>& corners)
    {
        std::vector<uint64_t> in, out;
        for (const uint64_t c : corners) (values_[c] < 0 ? in : out).push_back(c);
        if (in.empty() || out.empty()) return;
        const V3d outwards = middle(out) - middle(in);
        if (in.size() == 1) add({point(in[0], out[0]), point(in[0], out[1]), point(in[0], out[2])}, outwards);
        if (out.size() == 1) add({point(in[0], out[0]), point(in[1], out[0]), point(in[2], out[0])}, outwards);
        if (in.size() != 2) return;
        const uint32_t a = point(in[0], out[0]), b = point(in[0], out[1]), c = point(in[1], out[1]),
                       d = point(in[1], out[0]);
        add({a, b, c}, outwards);
        add({a, c, d}, outwards);
    }

    V3d middle(const std::vector<uint64_t>& corners) const
    {
        V3d sum(0);
        for (const uint64_t c : corners) sum += place(c);
        return sum / static_cast<double>(corners.size());
    }

    /// The vertex between two lattice points.
    uint32_t point(uint64_t in, uint64_t out)
    {
        const auto [found, is_new] = points_.try_emplace(std::min(in, out) * values_.size() + std::max(in, out),
                                                         static_cast<uint32_t>(mesh_.positions.size()));
        constexpr double margin = 0.05; // from lattice points, where triangles would have no area
        const double t = std::clamp(values_[in] / (values_[in] - values_[out]), margin, 1 - margin);
        if (is_new) mesh_.positions.push_back(place(in) + t * (place(out) - place(in)));
        return found->second;
    }

    void add(std::array<uint32_t, 3> triangle, const V3d& outwards)
    {
        const auto& p = mesh_.positions;
        if ((p[triangle[1]] - p[triangle[0]]).cross(p[triangle[2]] - p[triangle[0]]).dot(outwards) < 0)
            std::swap(triangle[1], triangle[2]);
        mesh_.triangles.push_back(triangle);
    }

    V3d lo_;
    double cell_;
    std::array<uint64_t, 3> count_{};
    std::vector<double> values_;
    std::unordered_map<uint64_t, uint32_t> points_;
    TriangleMesh mesh_;
};

} // namespace

TriangleMesh statue_mesh(int cells) { return Marcher({-0.32, -0.27, -0.01}, {0.32, 0.27, 1.02}, 1.0 / cells).run(); }

} // namespace scree
