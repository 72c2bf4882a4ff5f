// The scattering of a grain averaged over its rotations (GSDF), against exact values, and sampling against its density.

#include "base/warp.h"
#include "render/gsdf/gsdf_builder.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <memory>

namespace scree {
namespace {

std::shared_ptr<const Exemplar> exemplar_of(const TriangleMesh& mesh)
{
    static const EmbreeDevice device;
    return std::make_shared<Exemplar>(device, mesh, "test mesh");
}

/// The corner of a box: not symmetric under reflection, and far from round.
TriangleMesh chipped()
{
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 0.6}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    return mesh;
}

Material metal()
{
    Material material;
    material.kind = MaterialKind::conductor;
    return material;
}

/// Mean and standard error of the cosine over records that are drawn as in rendering.
Estimate cosine_of_records(const Gsdf& gsdf, uint32_t draws)
{
    Estimate cosine;
    Sampler sampler(3, 0, 0, 0);
    for (uint32_t i = 0; i < draws; ++i) {
        const double q = (i + 0.5) / draws;
        if (sampler.next() < gsdf.alpha0(q)) continue;
        const uint32_t stratum = Gsdf::stratum(q, sampler.next());
        const uint32_t cell = gsdf.sample_cell(stratum, sampler.next());
        cosine.add(gsdf.record(gsdf.pick(stratum, cell, sampler.next())).direction.unpack().z);
    }
    return cosine;
}

// Geometric optics of a sphere, Fresnel included (design, section 5).
TEST(Gsdf, SphereHasTheExactMeanCosine)
{
    for (const auto& [material, truth] : {std::pair{dielectric(1.5), 0.65009}, std::pair{dielectric(1.31), 0.78166},
                                          std::pair{lambert(0.3f), -4.0 / 9}}) {
        const auto gsdf = build_gsdf({nullptr, material}, {0.03});
        const GsdfQuality& quality = gsdf->data().quality;
        EXPECT_EQ(quality.lost, 0u);
        EXPECT_TRUE(gsdf->always_met());
        EXPECT_EQ(gsdf->mean_alpha0(), 0);
        EXPECT_LT(std::abs(quality.mean_cosine - truth), 4 * quality.mean_cosine_error);
        // The sampled mean has its own noise and the noise of the traced paths.
        const Estimate drawn = cosine_of_records(*gsdf, 2000000);
        EXPECT_LT(std::abs(drawn.mean() - truth), 4 * std::hypot(drawn.standard_error(), quality.mean_cosine_error));
        EXPECT_LT(std::abs(gsdf->mean_cosine() - truth), 1e-3);
        std::printf("mean cosine %.5f: all paths %.5f +- %.5f, records %.5f, drawn %.5f +- %.5f\n", truth,
                    quality.mean_cosine, quality.mean_cosine_error, gsdf->mean_cosine(), drawn.mean(),
                    drawn.standard_error());
    }
}

// Cauchy: the mean shadow of a convex body is a quarter of its surface S, so light from far away misses it with
// probability 1 - S / (4 pi) in the unit bounding sphere. A cube in the unit sphere has S = 8.
TEST(Gsdf, MissesAsOftenAsTheMeanShadowSays)
{
    const auto body = exemplar_of(cube());
    const auto gsdf = build_gsdf({body.get(), lambert(1)}, {0.1});
    const double truth = 1 - 8 / (4 * pi);
    const auto n = static_cast<double>(gsdf->data().quality.paths);
    EXPECT_LT(std::abs(gsdf->mean_alpha0() - truth), 4 * std::sqrt(truth * (1 - truth) / n)) << gsdf->mean_alpha0();
    EXPECT_GT(gsdf->alpha0(1), 0.9); // only the corners reach the sphere
    EXPECT_LT(gsdf->alpha0(0), 1e-3);
}

struct GsdfCase {
    std::string name;
    Material material;
    bool is_sphere;
};
void PrintTo(const GsdfCase& c, std::ostream* out) { *out << c.name; }

class EveryGsdf : public testing::TestWithParam<GsdfCase> {
protected:
    void SetUp() override
    {
        if (!GetParam().is_sphere) body_ = exemplar_of(chipped());
        gsdf_ = build_gsdf({body_.get(), GetParam().material}, {0.1});
    }
    void loses_nothing() const;
    void sampling_follows_its_density() const;
    void records_lie_in_their_cells() const;
    void density_integrates_to_the_mass_of_cells() const;
    void states_its_error_honestly() const;
    std::shared_ptr<const Exemplar> body_;
    std::shared_ptr<const Gsdf> gsdf_;
};

void EveryGsdf::loses_nothing() const
{
    EXPECT_EQ(gsdf_->data().quality.lost, 0u);
    for (uint32_t s = 0; s < Gsdf::strata; ++s) {
        double mass = 0;
        for (uint32_t c = 0; c < Gsdf::cells; ++c) {
            mass += gsdf_->cell_mass(s, c);
            EXPECT_TRUE(gsdf_->cell_mass(s, c) == 0 || !gsdf_->records(s, c).empty()) << "a cell without a record";
        }
        EXPECT_NEAR(mass, 1, 1e-6);
    }
    Material white = lossless(GetParam().material);
    if (white.kind == MaterialKind::conductor) return;
    for (uint32_t i = 0; i < gsdf_->data().records.size(); ++i) ASSERT_EQ(gsdf_->weight(i, white, 1), Color(1));
}

// The density that next-event estimation uses is the density of sampling, cell by cell.
void EveryGsdf::sampling_follows_its_density() const
{
    int strata = 0;
    double least = 1;
    for (uint32_t s = 1; s < Gsdf::strata; s += 6, ++strata) {
        constexpr uint32_t draws = 400000;
        std::vector<double> observed(Gsdf::cells), expected(Gsdf::cells);
        Sampler sampler(9, s, 0, 0);
        for (uint32_t i = 0; i < draws; ++i) ++observed[gsdf_->sample_cell(s, sampler.next())];
        for (uint32_t c = 0; c < Gsdf::cells; ++c) expected[c] = draws * gsdf_->cell_mass(s, c);
        least = std::min(least, chi_square(observed, expected).p_value);
    }
    EXPECT_GT(least, sidak(1e-4, strata));
}

void EveryGsdf::records_lie_in_their_cells() const
{
    uint64_t outside = 0, inward = 0, all = 0;
    for (uint32_t s = 0; s < Gsdf::strata; ++s) {
        for (uint32_t c = 0; c < Gsdf::cells; ++c) {
            for (const GsdfRecord& r : gsdf_->records(s, c)) {
                const V3d w = r.direction.unpack();
                ++all;
                const bool at_pole = std::abs(w.z) > 1 - 1e-4; // where columns are narrower than 16 bits resolve
                outside += !at_pole && DirectionGrid::cell(DirectionGrid::angles(w)) != c;
                inward += w.dot(r.point.unpack()) < -1e-4;
            }
        }
    }
    EXPECT_LT(static_cast<double>(outside), 0.01 * static_cast<double>(all)); // those on an edge, in 16 bits
    EXPECT_EQ(inward, 0u) << "paths leave the sphere";
}

// The density's integral over a cell is the cell's mass, by quadrature over 64 x 64 points of each.
void EveryGsdf::density_integrates_to_the_mass_of_cells() const
{
    for (const uint32_t s : {0u, 13u, 31u}) {
        for (uint32_t c = 0; c < Gsdf::cells; c += 37) {
            constexpr int n = 64;
            double sum = 0;
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    const double theta = (c / DirectionGrid::columns + (i + 0.5) / n) * DirectionGrid::row_width;
                    const double phi = (c % DirectionGrid::columns - 0.5 + (j + 0.5) / n) * DirectionGrid::column_width;
                    sum += gsdf_->density(s, DirectionGrid::direction(theta, phi)) * std::sin(theta);
                }
            }
            sum *= DirectionGrid::row_width * DirectionGrid::column_width / (n * n);
            EXPECT_NEAR(sum, gsdf_->cell_mass(s, c), 2e-3 * gsdf_->cell_mass(s, c) + 1e-9) << s << " " << c;
        }
    }
}

// Independent paths are distributed as the density says, in blocks of 8 x 8 cells of each stratum, within the paths'
// own noise and the error that the GSDF states.
void EveryGsdf::states_its_error_honestly() const
{
    std::vector<double> found(static_cast<size_t>(Gsdf::strata) * Gsdf::cells);
    uint64_t n = 0;
    for (uint32_t i = 0; i < 1000000; ++i) {
        Sampler sampler(77, i, 1, 0);
        const double u1 = sampler.next(), u2 = sampler.next();
        const V3d d = sample_sphere(u1, u2);
        const double q = sampler.next(), roll = 2 * pi * sampler.next();
        const Frame frame(d);
        const V3d entry = std::sqrt(q) * (std::cos(roll) * frame.s + std::sin(roll) * frame.t) - std::sqrt(1 - q) * d;
        const GrainExit exit = walk_grain({body_.get(), lossless(GetParam().material)}, entry, d, sampler);
        if (exit.events == 0) continue;
        const uint32_t cell = DirectionGrid::cell(DirectionGrid::angles(Encounter(entry, d).to_local(exit.direction)));
        ++found[static_cast<size_t>(q * Gsdf::strata) * Gsdf::cells + cell];
        ++n;
    }
    double error = 0, noise = 0;
    for (uint32_t s = 0; s < Gsdf::strata; ++s) {
        for (uint32_t row = 0; row < DirectionGrid::rows; row += 8) {
            for (uint32_t column = 0; column < DirectionGrid::columns; column += 8) {
                double counted = 0, said = 0;
                for (uint32_t i = 0; i < 64; ++i) {
                    const uint32_t cell = (row + i / 8) * DirectionGrid::columns + column + i % 8;
                    counted += found[static_cast<size_t>(s) * Gsdf::cells + cell] / static_cast<double>(n);
                    said += gsdf_->stratum_mass(s) * gsdf_->cell_mass(s, cell);
                }
                error += std::abs(counted - said);
                noise += std::sqrt(2 / pi * said / static_cast<double>(n));
            }
        }
    }
    EXPECT_LT(error, 1.2 * noise + gsdf_->data().quality.density_error)
        << "stated " << gsdf_->data().quality.density_error << ", noise " << noise;
    std::printf("%s: apart by %.4f over coarse cells, noise %.4f, stated (fine) %.4f\n", GetParam().name.c_str(), error,
                noise, gsdf_->data().quality.density_error);
}

TEST_P(EveryGsdf, HoldsWhatItPromises)
{
    loses_nothing();
    sampling_follows_its_density();
    records_lie_in_their_cells();
    density_integrates_to_the_mass_of_cells();
    states_its_error_honestly();
}

INSTANTIATE_TEST_SUITE_P(Types, EveryGsdf,
                         testing::Values(GsdfCase{"glass sphere", dielectric(1.5), true},
                                         GsdfCase{"rough glass sphere", dielectric(1.5, 0.4), true},
                                         GsdfCase{"white sphere", lambert(1), true},
                                         GsdfCase{"glass chip", dielectric(1.5), false},
                                         GsdfCase{"white chip", lambert(1), false},
                                         GsdfCase{"metal chip", metal(), false}));

// Length and events of records: the mean transmission of an absorbing sphere against paths that are absorbed one by
// one.
TEST(Gsdf, AbsorptionByLengthIsThatOfTheWay)
{
    const auto gsdf = build_gsdf({nullptr, dielectric(1.5)}, {0.05});
    Material tea = dielectric(1.5);
    tea.absorption = Color(0.7f, 0, 2);
    tea.tint = Color(1, 0.9f, 1);
    const double radius = 0.8;
    Estimate records[3], walked[3];
    for (uint32_t i = 0; i < 400000; ++i) {
        Sampler sampler(5, i, 0, 0);
        const double q = sampler.next();
        const uint32_t s = Gsdf::stratum(q, sampler.next());
        const uint32_t cell = gsdf->sample_cell(s, sampler.next());
        const Color weight = gsdf->weight(gsdf->pick(s, cell, sampler.next()), tea, radius);
        const V3d d(0, 0, 1), entry(std::sqrt(q), 0, -std::sqrt(1 - q));
        const GrainExit exit = walk_grain({nullptr, dielectric(1.5)}, entry, d, sampler);
        for (int c = 0; c < 3; ++c) {
            records[c].add(weight[c]);
            walked[c].add(std::exp(-tea.absorption[c] * radius * exit.length) * std::pow(tea.tint[c], exit.events));
        }
    }
    for (int c = 0; c < 3; ++c) {
        // 18,000 records represent all paths: the records' own error is a few times 1e-4.
        const double error = std::hypot(records[c].standard_error(), walked[c].standard_error(), 3e-4);
        EXPECT_LT(std::abs(records[c].mean() - walked[c].mean()), 4 * error)
            << c << ": " << records[c].mean() << " " << walked[c].mean();
    }
}

bool same(const Gsdf::Data& a, const Gsdf::Data& b)
{
    const auto bytes = [](const auto& v, const auto& w) {
        return v.size() == w.size() && std::memcmp(v.data(), w.data(), v.size() * sizeof(v[0])) == 0;
    };
    return bytes(a.alpha0, b.alpha0) && bytes(a.density, b.density) && bytes(a.first, b.first) &&
           bytes(a.records, b.records) && bytes(a.weights, b.weights);
}

TEST(Gsdf, IsTheSameForAnyNumberOfThreads)
{
    const auto body = exemplar_of(chipped());
    const GrainBody grain{body.get(), metal()};
    const auto many = build_gsdf(grain, {0.2});
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_TRUE(same(many->data(), build_gsdf(grain, {0.2})->data()));
    EXPECT_FALSE(same(many->data(), build_gsdf(grain, {.error = 0.2, .seed = 1})->data()));
}

TEST(Gsdf, PackedDirectionsAreClose)
{
    for (uint32_t i = 0; i < 100000; ++i) {
        Sampler sampler(1, i, 0, 0);
        const double u1 = sampler.next(), u2 = sampler.next();
        const V3d w = sample_sphere(u1, u2);
        ASSERT_LT((PackedDirection(w).unpack() - w).length(), 8e-5);
    }
    for (const V3d& w : {V3d(0, 0, 1), V3d(0, 0, -1), V3d(1, 0, 0), V3d(0, -1, 0), V3d(-1, 0, 0)}) {
        EXPECT_LT((PackedDirection(w).unpack() - w).length(), 8e-5);
    }
}

} // namespace
} // namespace scree
