#include "render/bench/half_pictures.h"

namespace scree {

namespace {

/// Sums over several films of one pixel.
struct Sums {
    double samples = 0;
    V3d sum{0}, squares{0};

    void add(const Pixel& pixel)
    {
        samples += pixel.samples;
        sum += pixel.sum;
        squares += pixel.sum_of_squares;
    }
    V3d mean() const { return samples > 0 ? sum / samples : V3d(0); }
    V3d variance() const
    {
        if (samples < 2) return V3d(0);
        const V3d m = mean(), v = (squares / samples - m * m) / (samples - 1);
        return {std::max(0.0, v.x), std::max(0.0, v.y), std::max(0.0, v.z)};
    }
};

} // namespace

HalfPictures make_halves(const std::vector<Film>& films)
{
    HalfPictures halves;
    halves.width = films.front().width();
    halves.height = films.front().height();
    double drawn_a = 0, drawn = 0;
    for (size_t p = 0; p < films.front().pixels().size(); ++p) {
        Sums half[2], all;
        for (size_t f = 0; f < films.size(); ++f) {
            half[f % 2].add(films[f].pixels()[p]);
            all.add(films[f].pixels()[p]);
        }
        halves.a.push_back(half[0].mean());
        halves.b.push_back(half[1].mean());
        halves.variance.push_back(all.variance());
        drawn_a += half[0].samples;
        drawn += all.samples;
    }
    if (drawn > 0) halves.share = drawn_a / drawn;
    return halves;
}

HalfPictures reduced(const HalfPictures& picture, int side)
{
    HalfPictures small;
    small.width = (picture.width + side - 1) / side;
    small.height = (picture.height + side - 1) / side;
    small.share = picture.share;
    small.halved = picture.halved;
    const size_t squares = static_cast<size_t>(small.width) * static_cast<size_t>(small.height);
    small.a.assign(squares, V3d(0));
    small.b = small.a;
    if (!picture.variance.empty()) small.variance = small.a;
    std::vector<double> count(squares, 0.0);
    for (size_t p = 0; p < picture.size(); ++p) {
        const size_t x = p % static_cast<size_t>(picture.width), y = p / static_cast<size_t>(picture.width);
        const size_t square =
            y / static_cast<size_t>(side) * static_cast<size_t>(small.width) + x / static_cast<size_t>(side);
        small.a[square] += picture.a[p];
        small.b[square] += picture.b[p];
        if (!picture.variance.empty()) small.variance[square] += picture.variance[p];
        ++count[square];
    }
    for (size_t s = 0; s < squares; ++s) {
        small.a[s] /= count[s];
        small.b[s] /= count[s];
        if (!small.variance.empty()) small.variance[s] /= count[s] * count[s];
    }
    return small;
}

V3d mean_radiance(const HalfPictures& picture)
{
    V3d sum(0);
    for (size_t p = 0; p < picture.size(); ++p) sum += picture.whole(p);
    return picture.size() > 0 ? sum / static_cast<double>(picture.size()) : sum;
}

} // namespace scree
