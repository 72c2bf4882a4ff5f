#include "render/grains/library/dendrite.h"

namespace scree {

namespace {

constexpr double half_sqrt3 = 0.86602540378443865;

V2d turned(const V2d& v, double cosine, double sine) { return {v.x * cosine - v.y * sine, v.x * sine + v.y * cosine}; }
V2d left_of(const V2d& v) { return {-v.y, v.x}; }

/// A branch of an arm, or a twig of a branch.
struct Limb {
    double at = 0; ///< where it begins: distance along its parent's middle line
    double length = 0; ///< from the parent's middle line to where its tip begins
    double width = 0; ///< half width
    std::vector<Limb> right, left; ///< in order of `at`; equal for a mirror-symmetric limb
};

/// Traces the outline around limbs: outwards along their right side, back along their left side.
class Tracing {
public:
    explicit Tracing(Dendrite& figure) : figure_(figure) {}

    /// Traces a limb, without the points where its flanks begin. base: where its middle line begins.
    void trace(const Limb& limb, const V2d& base, const V2d& along)
    {
        const V2d side = left_of(along);
        const auto point = [&](double x, double y) { return base + along * x + side * y; };
        for (const Limb& branch : limb.right) trace_branch(branch, limb.width, base, along, -1);
        figure_.outline.push_back(point(limb.length, -limb.width));
        figure_.outline.push_back(point(limb.length + limb.width / std::sqrt(3.0), 0)); // crystal faces at 120 degrees
        figure_.outline.push_back(point(limb.length, limb.width));
        for (auto branch = limb.left.rbegin(); branch != limb.left.rend(); ++branch)
            trace_branch(*branch, limb.width, base, along, 1);

        std::vector<double> stops{0, limb.length};
        for (const auto* branches : {&limb.right, &limb.left}) {
            for (const Limb& branch : *branches) stops.push_back(branch.at);
        }
        std::ranges::sort(stops);
        const auto repeated = std::ranges::unique(stops);
        stops.erase(repeated.begin(), repeated.end());
        std::vector<V2d> line;
        for (const double at : stops) line.push_back(base + along * at);
        figure_.middle_lines.push_back(std::move(line));
    }

private:
    /// Traces a branch at 60 degrees to its parent, with the points where its flanks leave the parent's flank. side: 1
    /// left, -1 right.
    void trace_branch(const Limb& branch, double parent_width, const V2d& parent_base, const V2d& parent_along,
                      int side)
    {
        const V2d base = parent_base + parent_along * branch.at, along = turned(parent_along, 0.5, side * half_sqrt3);
        const V2d across = left_of(along) * branch.width;
        const double root = parent_width / half_sqrt3, slant = side * branch.width / std::sqrt(3.0);
        figure_.outline.push_back(base + along * (root + slant) - across);
        trace(branch, base, along);
        figure_.outline.push_back(base + along * (root - slant) + across);
    }

    Dendrite& figure_;
};

/// Positions of `count` limbs between lo and hi: each is jittered within an equal share of the range.
std::vector<double> spread(int count, double lo, double hi, double jitter, ShapeRandom& random)
{
    std::vector<double> places;
    const double share = (hi - lo) / count;
    for (int i = 0; i < count; ++i) places.push_back(lo + share * (i + 0.5 + jitter * random.uniform(-0.5, 0.5)));
    return places;
}

} // namespace

Dendrite make_dendrite(const DendriteOptions& options, ShapeRandom& random)
{
    Limb arm{0, 1, options.width, {}, {}};
    // A narrower plate would leave no notch between the arms' flanks.
    const double plate = std::max(options.plate, 2.5 * options.width);
    const double first = plate + 2.4 * options.width, last = 0.93;
    const double spacing = (last - first) / std::max(1, options.branches);
    // The width, across a branch, for the branch and the twigs on both its sides: a part of the distance of neighbours.
    const double room = 0.7 * spacing * half_sqrt3;
    for (const double at : spread(options.branches, first, last, 0.3, random)) {
        // Branches are longest in the middle of the arm: at its tip they are young, near the plate they shade each
        // other.
        const double grown = std::min({1.0, 1.9 * (1 - at) + 0.1, at / 0.5});
        Limb branch{at,
                    options.branch_length * grown * random.uniform(0.6, 1),
                    std::min(0.7 * options.width, 0.22 * room),
                    {},
                    {}};
        // Tips stay within 30 degrees of their arm, because the next arm's sector begins there.
        branch.length = std::clamp(branch.length, 1.6 * options.width, 0.8 * at);
        const double twig_width = 0.5 * branch.width;
        const double reach = 0.5 * (room - 2 * branch.width) - twig_width;
        const double begin = 2.2 * options.width, end = 0.9 * branch.length;
        const int twigs = std::min(options.twigs, static_cast<int>((end - begin) / (5 * twig_width)));
        if (twigs > 0) {
            for (const double place : spread(twigs, begin, end, 0.2, random)) {
                const double root = branch.width / half_sqrt3,
                             grown_to = root + reach / half_sqrt3 * random.uniform(0.45, 1);
                // Beyond half of (at - place) a twig would leave the arm's sector.
                const double length = std::min(grown_to, 0.45 * (at - place) - 2 * twig_width);
                if (length > root + 2 * twig_width) branch.right.push_back({place, length, twig_width, {}, {}});
            }
            branch.left = branch.right;
        }
        arm.right.push_back(branch);
    }
    arm.left = arm.right;

    Dendrite figure;
    for (int k = 0; k < 6; ++k) {
        constexpr double cosines[] = {1, 0.5, -0.5, -1, -0.5, 0.5},
                         sines[] = {0, half_sqrt3, half_sqrt3, 0, -half_sqrt3, -half_sqrt3};
        const V2d along(cosines[k], sines[k]), side = left_of(along);
        Tracing tracing(figure);
        // The plate's corner is where the arm begins: the hexagon's edges run back from its flanks.
        const double corner = plate - options.width / std::sqrt(3.0);
        figure.outline.push_back(along * corner - side * options.width);
        tracing.trace(arm, V2d(0, 0), along);
        figure.outline.push_back(along * corner + side * options.width);
    }
    return figure;
}

} // namespace scree
