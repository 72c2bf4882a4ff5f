#include "render/grains/library/radial_surface.h"
#include "render/grains/library/shape_generator.h"
#include "render/grains/library/shape_random.h"

#include "base/noise.h"

namespace scree {

TriangleMesh make_bark_curl(const ShapeRequest& request)
{
    ShapeRandom random(request.seed, 0x626172);
    const double length = request["length"] * random.uniform(0.85, 1.15), thickness = request["thickness"];
    const double full_turns = request["turns"] * random.uniform(0.85, 1.15);
    const double arc = 2 * pi * full_turns * (1 + 0.5 * request["opening"] * full_turns);

    // Each side has n_u x n_v cells, and the rim joins the sides: 4 (n_u n_v + n_u + n_v) triangles. Cells are about
    // square.
    const double quarter = static_cast<double>(request.triangles) / 4;
    const double most_v = std::floor((quarter - 2) / 3); // leaves room for two cells along u
    const auto n_v = static_cast<uint32_t>(
        std::clamp(std::round(std::sqrt(quarter * length / arc) - 0.5), 1.0, std::max(1.0, most_v)));
    const auto n_u = static_cast<uint32_t>(std::max(2.0, std::round((quarter - n_v) / (n_v + 1))));
    const double turns = std::min(full_turns, n_u / 8.0); // few cells bent further would intersect each other

    NoiseOptions waves;
    waves.scale = V3d(0.7);
    waves.octaves = 2;
    waves.seed = random.next();
    const FractalNoise wave(waves);
    NoiseOptions fibres; // bark splits and furrows along its length
    fibres.scale = V3d(0.09, 0.09, 1.2);
    fibres.octaves = 2;
    fibres.seed = random.next();
    const FractalNoise furrow(fibres);
    NoiseOptions tears;
    tears.scale = V3d(0.35, 0.35, 0.35);
    tears.octaves = 1 + static_cast<int>(std::clamp(std::log2(0.17 / mean_edge(request.triangles)), 0.0, 4.0));
    tears.seed = random.next();
    const FractalNoise tear(tears);
    const double raggedness = request["raggedness"], roughness = request["roughness"];

    const auto point = [&](double u, double v, double side) { // u, v in 0..1 over the sheet, side 0 inner, 1 outer
        // Bark tears across its fibres: the ends are ragged, the long edges nearly straight, so that the sheet has no
        // fold.
        const double across = (u - 0.5) * (1 + 0.1 * wave(V3d(7, u < 0.5 ? 0.0 : 5.0, 2 * v)));
        const double along = (v - 0.5) * (1 + raggedness * tear(V3d(v < 0.5 ? 1.0 : 4.0, 9, 3 * u * turns)));
        const double turn = turns * (across + 0.5), angle = 2 * pi * turn;
        const V3d place(std::cos(angle), std::sin(angle), length * along);
        double r = 1 + request["opening"] * turn + 0.35 * thickness * wave(place);
        const double skin = thickness * (0.8 + 0.4 * wave(place + V3d(5)));
        r += side * skin + (side > 0.5 ? 1 : 0.6) * roughness * thickness * furrow((1 + turn) * place);
        return V3d(r * std::cos(angle), r * std::sin(angle), length * along);
    };
    TriangleMesh mesh;
    const auto index = [&](uint32_t i, uint32_t j, uint32_t side) {
        return side * (n_u + 1) * (n_v + 1) + i * (n_v + 1) + j;
    };
    for (const double side : {0.0, 1.0}) {
        for (uint32_t i = 0; i <= n_u; ++i) {
            for (uint32_t j = 0; j <= n_v; ++j)
                mesh.positions.push_back(point(static_cast<double>(i) / n_u, static_cast<double>(j) / n_v, side));
        }
    }
    const auto quad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    for (uint32_t i = 0; i < n_u; ++i) {
        for (uint32_t j = 0; j < n_v; ++j) {
            quad(index(i, j, 1), index(i + 1, j, 1), index(i + 1, j + 1, 1), index(i, j + 1, 1));
            quad(index(i, j, 0), index(i, j + 1, 0), index(i + 1, j + 1, 0), index(i + 1, j, 0));
        }
        quad(index(i, 0, 0), index(i + 1, 0, 0), index(i + 1, 0, 1), index(i, 0, 1));
        quad(index(i, n_v, 1), index(i + 1, n_v, 1), index(i + 1, n_v, 0), index(i, n_v, 0));
    }
    for (uint32_t j = 0; j < n_v; ++j) {
        quad(index(0, j, 0), index(0, j, 1), index(0, j + 1, 1), index(0, j + 1, 0));
        quad(index(n_u, j, 0), index(n_u, j + 1, 0), index(n_u, j + 1, 1), index(n_u, j, 1));
    }
    return mesh;
}

} // namespace scree
