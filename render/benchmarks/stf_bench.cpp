// Shell tracing against path tracing in a statue filled with a medium of snow's phase function, as in figure 4 of
// Müller et al. 2016. usage: stf_bench [seconds per method and row, default 10] [mean free paths per height, default
// 10,30,100,300,1000] [albedos, default 0.99,0.999,1]
//                  [forms, default full,cosine,hg,interpolated,diffusion] [seconds of a row's reference, default 30]
//                  [pixels across, default 64] [accuracy of the tables, default standard] [closed mesh in place of the
//                  statue, its height along z]

#include "base/error.h"
#include "render/build/shell_builder.h"
#include "render/build/type_builder.h"
#include "render/embree/embree_device.h"
#include "render/equivalent/grain_moments.h"
#include "render/grains/shape_source.h"
#include "render/gsdf/gsdf_cache.h"
#include "render/integrators/path_tracer.h"
#include "render/stf/medium_shells.h"
#include "tests/builders/statistics.h"
#include "tests/builders/statue.h"

#include <fmt/format.h>

#include <ctime>
#include <sstream>

namespace {

using namespace scree;

/// Processor seconds of this program: other programs on a busy machine do not count.
double busy_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::vector<std::string> words(const std::string& list)
{
    std::vector<std::string> all;
    std::istringstream in(list);
    for (std::string word; std::getline(in, word, ',');) all.push_back(word);
    return all;
}

std::shared_ptr<const PhaseTable> snow_phase()
{
    const LibraryGrain& grain = *find_library_grain("snowflake");
    const EmbreeDevice device;
    const ShapeSource shape{{}, &grain, {}};
    const GsdfSource source{hash_shape(shape), grain.material,
                            [&] { return make_exemplar(device, shape, grain.material, "snowflake", "snowflake"); }};
    const FoundGsdf found = find_gsdf(source, gsdf_options(Accuracy::standard), cache_folder());
    return std::make_shared<PhaseTable>(grain_moments(*found.gsdf).phase);
}

/// The mesh, scaled to height 1 and centred, and lights from all around and from the sun.
class Scene {
public:
    Scene(const TriangleMesh& mesh, uint32_t columns) : columns_(columns), rows_(columns * 3 / 2)
    {
        Imath::Box3d box;
        for (const V3d& p : mesh.positions) box.extendBy(p);
        MediumRegion region{"statue", {}, mesh.triangles, nullptr, nullptr};
        for (const V3d& p : mesh.positions) region.positions.emplace_back((p - box.center()) / box.size().z);
        region.medium = std::make_shared<HomogeneousMedium>(V3d(1), Color(1), 0.0);
        world.regions.push_back(std::move(region));
        Light sky, sun;
        sun.kind = LightKind::distant;
        sun.direction = V3d(-0.5, -0.7, 0.6).normalized();
        sun.one_minus_cos = 1e-5;
        sun.radiance = Color(5e4f); // the irradiance of the sky
        world.lights = LightSet({sky, sun}, 0.7);
        Stopwatch watch;
        world.clearance = make_clearance(world, Progress());
        fmt::print("{} triangles; clearances made in {:.2f} s, {:.1f} MB, largest {:.3f} of the height\n",
                   mesh.triangles.size(), watch.seconds(), 1e-6 * static_cast<double>(world.clearance->bytes()),
                   world.clearance->largest());
        const auto device = std::make_shared<EmbreeDevice>();
        tracer = std::make_unique<Tracer>(device, world);
        const std::shared_ptr<const ClearanceField> known = std::exchange(world.clearance, nullptr);
        plain = std::make_unique<Tracer>(device, world);
        world.clearance = known;
        for (uint32_t p = 0; p < columns_ * rows_; ++p) {
            RegionSet outside = 0;
            if (Crossing crossing;
                tracer->regions()->next(eye(p, 0.5, 0.5), forwards, 0, 4, nullptr, outside, crossing))
                pixels.push_back(p);
        }
    }

    PathResult trace(const Tracer& by, uint32_t pixel, uint64_t seed, uint32_t sample) const
    {
        Sampler sampler(seed, pixel, 0, sample);
        const double u = sampler.next(), v = sampler.next();
        return trace_path(world, by, eye(pixel, u, v), forwards, sampler);
    }

    World world;
    std::unique_ptr<Tracer> tracer, plain; ///< plain: without clearances, so that every step and every light is a ray
    std::vector<uint32_t> pixels; ///< whose middle shows the statue

private:
    static inline const V3d forwards{0, 1, 0};
    /// From the front, orthographic; 1.05 of the height is seen.
    V3d eye(uint32_t pixel, double u, double v) const
    {
        const double size = 1.05 / rows_;
        return {size * (pixel % columns_ + u - 0.5 * columns_), -2, size * (0.5 * rows_ - pixel / columns_ - v)};
    }

    uint32_t columns_, rows_;
};

constexpr const char* plain_name = "VPT plain";

/// The paths of one method: pixels in two independent halves, and the cost of the paths.
class Picture {
public:
    Picture(std::string name, std::shared_ptr<const MediumShells> shells, uint64_t seed, size_t pixels)
        : name_(std::move(name)), shells_(std::move(shells)), seed_(seed)
    {
        for (auto& half : halves_) half.resize(pixels);
    }

    /// Adds paths for `seconds` of processor time; complete() then adds paths until each half has two a pixel.
    void add_paths(Scene& scene, double seconds)
    {
        scene.world.regions[0].shells = shells_;
        const Tracer& tracer = name_ == plain_name ? *scene.plain : *scene.tracer;
        const double start = busy_seconds();
        const uint64_t count = scene.pixels.size();
        do {
            // Pixels in turns, but neighbours not one after another.
            const uint64_t pass = paths_ / count, pixel = paths_ % count * 7919 % count;
            const PathResult result = scene.trace(tracer, scene.pixels[pixel], seed_, static_cast<uint32_t>(pass));
            halves_[pass & 1][pixel].add(double{result.radiance.x});
            ++paths_;
            events_ += result.events;
            steps_ += result.shells;
            shadow_rays_ += result.shadow_rays;
            segments_ += result.segments;
        } while (busy_seconds() - start < seconds);
        seconds_ += busy_seconds() - start;
    }
    void complete(Scene& scene)
    {
        while (paths_ < 4 * scene.pixels.size()) add_paths(scene, 0);
    }

    const std::string& name() const { return name_; }
    uint64_t paths() const { return paths_; }
    double per_path(uint64_t Picture::*what) const
    {
        return static_cast<double>(this->*what) / static_cast<double>(paths_);
    }
    double seconds_per_path() const { return seconds_ / static_cast<double>(paths_); }
    double mean(size_t half, size_t pixel) const { return halves_[half][pixel].mean(); }
    double mean(size_t pixel) const { return 0.5 * (mean(0, pixel) + mean(1, pixel)); }
    /// The variance of one path of a pixel, estimated from one half.
    double variance(size_t half, size_t pixel) const
    {
        const Estimate& e = halves_[half][pixel];
        return e.standard_error() * e.standard_error() * static_cast<double>(e.count());
    }
    Estimate image() const
    {
        Estimate all;
        for (size_t i = 0; i < halves_[0].size(); ++i) all.add(mean(i));
        return all;
    }
    /// Standard error of the mean over all pixels.
    double standard_error() const
    {
        double sum = 0;
        for (const auto& half : halves_)
            for (const Estimate& e : half) sum += e.standard_error() * e.standard_error();
        return 0.5 * std::sqrt(sum) / static_cast<double>(halves_[0].size());
    }

    uint64_t events_ = 0, steps_ = 0, shadow_rays_ = 0, segments_ = 0;

private:
    std::string name_;
    std::shared_ptr<const MediumShells> shells_;
    uint64_t seed_;
    std::array<std::vector<Estimate>, 2> halves_;
    uint64_t paths_ = 0;
    double seconds_ = 0;
};

/// The mean over pixels of a path's variance divided by the square of the pixel.
double variance(const Picture& picture, size_t half, const std::vector<double>& squares)
{
    double sum = 0;
    for (size_t i = 0; i < squares.size(); ++i) sum += picture.variance(half, i) / squares[i];
    return sum / static_cast<double>(squares.size());
}

void print_row(const std::vector<Picture>& pictures, const Picture& reference, size_t pixels)
{
    // Errors are relative to the mean of all methods, so that the divisor depends as little as possible on the product
    // that it divides.
    std::vector<double> squares(pixels, 0);
    double level = 0;
    for (size_t i = 0; i < pixels; ++i) {
        for (const Picture& p : pictures) squares[i] += p.mean(i) / static_cast<double>(pictures.size());
        level += squares[i] / static_cast<double>(pixels);
    }
    for (double& s : squares) s = s * s + 0.01 * level * level;

    fmt::print("  {:<13}{:>9}{:>11}{:>9}{:>10}{:>9}{:>9}{:>10}{:>11}{:>16}{:>18}{:>24}\n", "", "paths", "us a path",
               "events", "segments", "shadows", "shells", "variance", "TTUV ms", "VPT's / this", "mean, %",
               "MRSE, 1e-4");
    for (const Picture& p : pictures) {
        std::array<double, 2> v{}, ratio{};
        for (size_t half = 0; half < 2; ++half) {
            v[half] = variance(p, half, squares);
            ratio[half] = variance(pictures[0], half, squares) * pictures[0].seconds_per_path() /
                          (v[half] * p.seconds_per_path());
        }
        Estimate mrse;
        for (size_t i = 0; i < pixels; ++i)
            mrse.add((p.mean(0, i) - reference.mean(0, i)) * (p.mean(1, i) - reference.mean(1, i)) / squares[i]);
        const double truth = reference.image().mean(), off = p.image().mean() / truth - 1,
                     off_by = std::hypot(p.standard_error(), reference.standard_error()) / truth;
        const auto doubt = [](double x, double error) {
            return std::abs(x) < 2 * error ? "~" : " ";
        }; // below the noise
        fmt::print("  {:<13}{:>9}{:>11.1f}{:>9.1f}{:>10.2f}{:>9.2f}{:>9.2f}{:>10.3f}{:>11.3f}{:>9.2f} "
                   "+-{:>4.1f}{:>10.2f} +-{:>4.2f}{}{:>12.2f} +-{:>7.2f}{}\n",
                   p.name(), p.paths(), 1e6 * p.seconds_per_path(), p.per_path(&Picture::events_),
                   p.per_path(&Picture::segments_), p.per_path(&Picture::shadow_rays_), p.per_path(&Picture::steps_),
                   0.5 * (v[0] + v[1]), 500 * (v[0] + v[1]) * p.seconds_per_path(), 0.5 * (ratio[0] + ratio[1]),
                   0.5 * std::abs(ratio[0] - ratio[1]), 100 * off, 100 * off_by, doubt(off, off_by), 1e4 * mrse.mean(),
                   1e4 * mrse.standard_error(), doubt(mrse.mean(), mrse.standard_error()));
    }
    std::fflush(stdout);
}

void run_row(Scene& scene, const std::vector<StfForm>& forms, StfCache& cache, double seconds, double reference_seconds)
{
    constexpr int turns = 5;
    std::vector<Picture> pictures;
    pictures.emplace_back("VPT", nullptr, 1, scene.pixels.size());
    pictures.emplace_back(plain_name, nullptr, 200, scene.pixels.size());
    for (const StfForm form : forms) {
        std::vector<PartReport> parts;
        std::vector<std::string> remarks;
        scene.world.regions[0].shells = nullptr;
        add_shells({form}, cache, scene.world, parts, remarks, Progress());
        for (const PartReport& part : parts)
            fmt::print("  {}: {}; {:.2f} s, {:.1f} MB\n", stf_form_names[form], part.reason, part.seconds,
                       1e-6 * static_cast<double>(part.bytes));
        pictures.emplace_back(stf_form_names[form], scene.world.regions[0].shells, 2 + static_cast<uint64_t>(form),
                              scene.pixels.size());
    }
    Picture reference("reference", nullptr, 100, scene.pixels.size());
    for (int turn = 0; turn < turns; ++turn) {
        for (Picture& p : pictures) p.add_paths(scene, seconds / turns);
        reference.add_paths(scene, reference_seconds / turns);
    }
    for (Picture& p : pictures) p.complete(scene);
    reference.complete(scene);
    fmt::print("  reference: {} paths, mean {:.5f} +- {:.2f} %\n", reference.paths(), reference.image().mean(),
               100 * reference.standard_error() / reference.image().mean());
    print_row(pictures, reference, scene.pixels.size());
}

} // namespace

int main(int argc, char** argv)
{
    const auto argument = [&](int i, const char* absent) { return std::string(argc > i ? argv[i] : absent); };
    try {
        const double seconds = std::atof(argument(1, "10").c_str()),
                     reference_seconds = std::atof(argument(5, "30").c_str());
        std::vector<StfForm> forms;
        for (const std::string& word : words(argument(4, "full,cosine,hg,interpolated,diffusion"))) {
            const std::optional<StfForm> form = stf_form_names.find(word);
            if (!form)
                throw InputError("forms", word, "one of " + fmt::format("{}", fmt::join(stf_form_names.words(), ", ")));
            forms.push_back(*form);
        }
        const std::optional<Accuracy> accuracy = accuracy_names.find(argument(7, "standard"));
        if (!accuracy)
            throw InputError("accuracy", argument(7, ""),
                             "one of " + fmt::format("{}", fmt::join(accuracy_names.words(), ", ")));
        StfCache cache(cache_folder(), stf_options(*accuracy));
        const auto phase = snow_phase();
        fmt::print("mean cosine of the phase function {:.4f}\n", phase->mean_cosine());
        Scene scene(argc > 8 ? read_closed_mesh(argv[8], "it is filled with a medium") : statue_mesh(),
                    static_cast<uint32_t>(std::atoi(argument(6, "64").c_str())));
        fmt::print(
            "{} pixels show the object. Times are processor times of one thread; ~: less than two standard errors.\n",
            scene.pixels.size());
        flush_subnormals();
        for (const std::string& length : words(argument(2, "10,30,100,300,1000"))) {
            for (const std::string& albedo : words(argument(3, "0.99,0.999,1"))) {
                fmt::print("\n{} mean free paths, albedo {}\n", length, albedo);
                scene.world.regions[0].medium =
                    std::make_shared<HomogeneousMedium>(V3d(std::stod(length)), Color(std::stof(albedo)), phase);
                run_row(scene, forms, cache, seconds, reference_seconds);
            }
        }
    } catch (const InputError& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
