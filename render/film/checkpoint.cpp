#include "render/film/checkpoint.h"

#include "ingest/support/atomic_file.h"
#include "ingest/support/error.h"

#include <array>
#include <cstring>
#include <fstream>
#include <type_traits>

namespace scree {

namespace {

// Plain numbers without pointers, though Imath's constructors keep them from being trivially copyable.
static_assert(std::is_standard_layout_v<Pixel> && std::is_trivially_destructible_v<Pixel>);

/// The head of the file: everything that must agree, in the machine's own byte order and layout.
struct Head {
    std::array<char, 8> magic{'s', 'c', 'r', 'e', 'e', 'c', 'k', '1'};
    uint64_t scene_hash, seed, pixel_bytes = sizeof(Pixel);
    std::array<int32_t, 6> window;

    Head(const Film& film, const CheckpointKey& key)
        : scene_hash(key.scene_hash), seed(key.seed),
          window{film.width(), film.height(), film.x0(), film.y0(), film.x1(), film.y1()}
    {
    }
};

} // namespace

void write_checkpoint(const std::filesystem::path& path, const Film& film, const CheckpointKey& key)
{
    AtomicFile file(path);
    std::ofstream out(file.temporary(), std::ios::binary);
    const Head head(film, key);
    out.write(reinterpret_cast<const char*>(&head), sizeof head);
    out.write(reinterpret_cast<const char*>(film.pixels().data()), static_cast<std::streamsize>(film.pixels().size() * sizeof(Pixel)));
    out.close();
    if (!out) throw InputError(path.string(), "a disk that is full or cannot be written", "room for the checkpoint");
    file.commit();
}

void read_checkpoint(const std::filesystem::path& path, Film& film, const CheckpointKey& key)
{
    std::ifstream in(path, std::ios::binary);
    const Head expected(film, key);
    Head found = expected;
    in.read(reinterpret_cast<char*>(&found), sizeof found);
    if (!in || found.magic != expected.magic || found.pixel_bytes != expected.pixel_bytes) {
        throw InputError(path.string(), "no checkpoint of this version", "a checkpoint", "remove it, or render without --resume");
    }
    if (std::memcmp(&found, &expected, sizeof found) != 0) {
        throw InputError(path.string(), "a checkpoint of another picture (scene, input, seed, size or crop differ)",
                         "one of this picture", "remove it, or render without --resume");
    }
    std::vector<Pixel> pixels(film.pixels().size());
    in.read(reinterpret_cast<char*>(pixels.data()), static_cast<std::streamsize>(pixels.size() * sizeof(Pixel)));
    if (!in) throw InputError(path.string(), "a checkpoint that ends early", "a whole one", "remove it, or render without --resume");
    film.pixels() = std::move(pixels);
}

} // namespace scree
