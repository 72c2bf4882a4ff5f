#include "render/bench/reference_picture.h"

#include "base/error.h"
#include "render/bench/exr_planes.h"
#include "render/bench/machine.h"
#include "render/bench/method_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace scree {

namespace {

constexpr const char* colors[] = {"R", "G", "B"};
constexpr const char* half_names[] = {"a.", "b."};

V3d color_at(const ExrPlanes& file, const std::string& prefix, size_t pixel)
{
    return {file.planes.at(prefix + "R")[pixel], file.planes.at(prefix + "G")[pixel],
            file.planes.at(prefix + "B")[pixel]};
}

bool has_color(const ExrPlanes& file, const std::string& prefix)
{
    for (const char* c : colors)
        if (!file.planes.contains(prefix + c)) return false;
    return true;
}

void add_color(ExrPlanes& file, const std::string& prefix, const V3d& value)
{
    for (int c = 0; c < 3; ++c) file.planes[prefix + colors[c]].push_back(static_cast<float>(value[c]));
}

/// The films as planes: the mean, count and variance of the mean of each, from which rendering can continue.
ExrPlanes planes_of(const MethodRun& method)
{
    ExrPlanes file;
    file.width = method.films()[0].width();
    file.height = method.films()[0].height();
    const HalfPictures halves = make_halves(method.films());
    for (size_t p = 0; p < halves.size(); ++p) {
        add_color(file, "", halves.whole(p));
        add_color(file, "variance.", halves.variance[p]);
        for (size_t h = 0; h < 2; ++h) {
            const Pixel& pixel = method.films()[h].pixels()[p];
            const Color variance = pixel.variance();
            add_color(file, half_names[h], h == 0 ? halves.a[p] : halves.b[p]);
            add_color(file, std::string(half_names[h]) + "variance.", V3d(variance.x, variance.y, variance.z));
            file.planes[std::string(half_names[h]) + "samples"].push_back(static_cast<float>(pixel.samples));
            file.planes[std::string(half_names[h]) + "drawn"].push_back(static_cast<float>(pixel.drawn));
        }
    }
    return file;
}

Film film_of(const ExrPlanes& file, const std::string& half)
{
    Film film(file.width, file.height, 0, 0, file.width, file.height);
    for (size_t p = 0; p < film.pixels().size(); ++p) {
        Pixel& pixel = film.pixels()[p];
        const V3d mean = color_at(file, half, p), variance = color_at(file, half + "variance.", p);
        pixel.samples = static_cast<uint32_t>(file.planes.at(half + "samples")[p]);
        pixel.drawn = static_cast<uint32_t>(file.planes.at(half + "drawn")[p]);
        const double n = pixel.samples;
        pixel.sum = n * mean;
        pixel.sum_of_squares = n * (variance * std::max(0.0, n - 1) + mean * mean);
    }
    return film;
}

HalfPictures halves_of(const ExrPlanes& file, const std::filesystem::path& path)
{
    if (!has_color(file, "")) throw InputError(path.string(), "no channels R, G and B", "a picture in colour");
    HalfPictures picture;
    picture.width = file.width;
    picture.height = file.height;
    picture.halved = has_color(file, "a.") && has_color(file, "b.");
    const auto share = file.numbers.find("shareOfA");
    if (picture.halved && share != file.numbers.end()) picture.share = share->second;
    const bool varied = has_color(file, "variance.");
    const size_t pixels = file.planes.at("R").size();
    for (size_t p = 0; p < pixels; ++p) {
        picture.a.push_back(color_at(file, picture.halved ? "a." : "", p));
        picture.b.push_back(color_at(file, picture.halved ? "b." : "", p));
        if (varied) picture.variance.push_back(color_at(file, "variance.", p));
        const V3d sum = picture.a.back() + picture.b.back();
        if (!std::isfinite(sum.x + sum.y + sum.z))
            throw InputError(path.string(), "a pixel that is not finite", "a picture to compare with");
    }
    return picture;
}

void check_size(const ExrPlanes& file, int width, int height, const std::filesystem::path& path)
{
    if (file.width == width && file.height == height) return;
    throw InputError(path.string(), fmt::format("a picture of {}x{}", file.width, file.height),
                     fmt::format("a picture of {}x{}, the size of the scene's film", width, height),
                     fmt::format("ask for --size {}x{}", file.width, file.height));
}

} // namespace

ReferencePicture read_reference(const std::filesystem::path& path, int width, int height)
{
    const ExrPlanes file = read_exr_planes(path);
    check_size(file, width, height, path);
    ReferencePicture reference{halves_of(file, path), path.filename().string(), 0, 0, "", ""};
    if (const auto it = file.numbers.find("processorSeconds"); it != file.numbers.end())
        reference.processor_seconds = it->second;
    if (const auto it = file.numbers.find("spp"); it != file.numbers.end())
        reference.samples = static_cast<uint64_t>(it->second);
    if (const auto it = file.texts.find("referenceKey"); it != file.texts.end()) reference.key = it->second;
    return reference;
}

ReferencePicture render_reference(MethodRun& method, const std::filesystem::path& path, uint64_t seed,
                                  double processor_seconds, const Progress& progress)
{
    const std::string job = fmt::format("{:016x} {} {} ", method.scene_hash(), method.plan_name(), seed),
                      key = job + build_identity();
    std::string note;
    double before = 0,
           asked = 0; // processor seconds: taken and asked for (they differ, as slices end with whole samples)
    if (std::filesystem::exists(path)) {
        try {
            const ExrPlanes file = read_exr_planes(path);
            const bool same_size = file.width == method.films()[0].width() && file.height == method.films()[0].height();
            const auto kept = file.texts.find("referenceKey");
            if (kept == file.texts.end())
                throw InputError(path.string(), "a picture that `scree bench` did not render",
                                 "no file, or a reference of `scree bench`",
                                 "move it away, or name it with --reference");
            if (same_size && kept->second == key) {
                for (size_t h = 0; h < 2; ++h) method.restore(h, film_of(file, half_names[h]));
                before = file.numbers.at("processorSeconds");
                asked = file.numbers.at("secondsAsked");
            } else {
                const std::filesystem::path aside = path.parent_path() / (path.stem().string() + "-before.exr");
                std::filesystem::rename(path, aside);
                note = fmt::format(
                    "the reference in the folder was of another {} and is rendered again; the old one is "
                    "kept as {}, which --reference accepts",
                    same_size && kept->second.rfind(job, 0) == 0 ? "build of scree" : "scene, size, method or seed",
                    aside.string());
            }
        } catch (const std::out_of_range&) {
            throw InputError(path.string(), "a reference with missing channels", "a complete one", "remove it");
        } catch (const std::filesystem::filesystem_error& error) {
            throw InputError(path.string(), error.what(), "a reference that can be moved aside");
        }
    }
    constexpr double each = 30; // seconds of work that are lost when the program is killed
    const double left = asked < processor_seconds ? std::max(0.0, processor_seconds - before) : 0;
    const int slices = left > 0 ? std::max(8, static_cast<int>(std::min(1e6, left / each))) : 0;
    std::optional<ExrPlanes> unsaved;
    auto save = [&] {
        if (unsaved) write_exr_planes(path, *unsaved);
        unsaved.reset();
    };
    const Stopwatch watch;
    double saved = 0;
    try {
        for (int slice = 1; slice <= slices; ++slice) { // the halves in turn
            for (size_t h = 0; h < 2; ++h) method.render_until(h, 0.5 * left * slice / slices, progress);
            unsaved = planes_of(method);
            unsaved->texts = {{"software", "Scree"},
                              {"version", SCREE_VERSION},
                              {"integrator", method.plan_name()},
                              {"referenceKey", key}};
            unsaved->numbers = {{"processorSeconds", before + method.total_time().processor},
                                {"secondsAsked", before + left * slice / slices},
                                {"spp", static_cast<double>(method.total_samples())},
                                {"shareOfA", make_halves(method.films()).share}};
            if (slice == slices || watch.seconds() > saved + each) {
                save();
                saved = watch.seconds();
            }
            progress.update("reference", static_cast<double>(slice) / slices);
        }
    } catch (const Cancelled&) {
        save();
        throw;
    }
    return {make_halves(method.films()), method.name(), before + method.total_time().processor,
            method.total_samples(),      key,           note};
}

} // namespace scree
