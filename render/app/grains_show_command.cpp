#include "render/app/grains_command.h"

#include "base/atomic_file.h"
#include "base/console_progress.h"
#include "base/drawing/picture.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "render/app/grain_portrait.h"
#include "render/app/table_command.h"
#include "render/film/exr_output.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>
#include <optional>

namespace scree {

namespace {

struct Arguments {
    std::vector<std::string> names;
    std::string output;
    PortraitOptions portrait;
    ShapeOptions shape;
    int threads = 0;
    bool quiet = false;
};

uint8_t to_screen(float x)
{
    x = std::clamp(x, 0.0f, 1.0f); // IEC 61966-2-1
    const float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
    return static_cast<uint8_t>(255 * encoded + 0.5f);
}

void place_portrait(const Film& film, int x0, int y0, Picture& sheet)
{
    for (int y = 0; y < film.height(); ++y) {
        for (int x = 0; x < film.width(); ++x) {
            const Color c = film.at(x, y).mean();
            sheet.fill_rectangle(x0 + x, y0 + y, 1, 1, {to_screen(c.x), to_screen(c.y), to_screen(c.z)});
        }
    }
}

void show(const Arguments& a)
{
    std::vector<const LibraryGrain*> grains;
    for (const std::string& name : a.names) grains.push_back(&require_library_grain(name, "scree grains show"));
    if (grains.empty()) {
        for (const LibraryGrain& grain : grain_library()) grains.push_back(&grain);
    }
    check_preview_format(a.output);
    AtomicFile(a.output); // throws before the work if it cannot be written

    const int count = static_cast<int>(grains.size());
    const int columns = count <= 3 ? count : static_cast<int>(std::ceil(std::sqrt(1.4 * count)));
    const int size = a.portrait.size, scale = std::max(1, size / 130), margin = 2 * scale,
              label = Picture::text_height(scale) + 2 * margin;
    const int rows = (count + columns - 1) / columns;
    Picture sheet(columns * (size + margin) + margin, rows * (size + label + margin) + margin, {255, 255, 255});

    ConsoleProgress console(a.quiet);
    const InterruptGuard guard(console.progress());
    for (int i = 0; i < count; ++i) {
        const LibraryGrain& grain = *grains[static_cast<size_t>(i)];
        console.set_prefix(fmt::format("{} ({} of {})", grain.name, i + 1, count));
        const Film film = render_portrait(grain, a.shape, a.portrait, "scree grains show", console.progress());
        const int x = margin + i % columns * (size + margin), y = margin + i / columns * (size + label + margin);
        place_portrait(film, x, y, sheet);
        sheet.draw_text(x + (size - Picture::text_width(grain.name, scale)) / 2, y + size + margin, grain.name,
                        {40, 40, 40}, scale);
    }
    console.finish();
    sheet.write(a.output);
}

} // namespace

void add_grains_show_command(CLI::App& grains)
{
    auto arguments = std::make_shared<Arguments>();
    Arguments& a = *arguments;
    CLI::App* command = grains.add_subcommand(
        "show", "Render a sheet with a picture of each grain type, at its typical size in daylight");
    command->add_option("name", a.names, "Grain types to show (default: all)");
    command->add_option("-o,--output", a.output, "Picture to write: .png, .jpg, ...")->required();
    command->add_option("--size", a.portrait.size, "Width and height of each picture, pixels")
        ->check(CLI::Range(16, 4096));
    command->add_option("--spp", a.portrait.spp, "Samples per pixel")->check(CLI::Range(1u, 1u << 20));
    command->add_option("--triangles", a.shape.triangles, "About how many triangles per shape (default: the type's)")
        ->check(CLI::Range(least_shape_triangles, most_shape_triangles));
    command->add_option("--seed", a.shape.seed, "Seed of the individual shapes")->check(CLI::NonNegativeNumber);
    command->add_option("-t,--threads", a.threads, "Threads (default: all cores)")->check(CLI::Range(1, 4096));
    command->add_flag("-q,--quiet", a.quiet, "Show no progress");
    command->callback([arguments] { run_command(arguments->threads, [&] { show(*arguments); }); });
}

} // namespace scree
