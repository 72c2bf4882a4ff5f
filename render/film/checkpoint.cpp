#include "render/film/checkpoint.h"

#include "base/atomic_file.h"
#include "base/error.h"

#include <array>
#include <cstring>
#include <fstream>
#include <type_traits>

namespace scree {

namespace {

// Plain numbers without pointers; only Imath's constructors make them not trivially copyable.
template <class T>
inline constexpr bool plain = std::is_standard_layout_v<T>&& std::is_trivially_destructible_v<T>;
static_assert(plain<Pixel> && plain<PixelHalves> && plain<TileState>);

template <class T>
void write_all(std::ofstream& out, const std::vector<T>& items)
{
    out.write(reinterpret_cast<const char*>(items.data()), static_cast<std::streamsize>(items.size() * sizeof(T)));
}

/// Reads as many items as there are in `like`.
template <class T>
std::vector<T> read_all(std::ifstream& in, const std::vector<T>& like)
{
    std::vector<T> items(like.size());
    in.read(reinterpret_cast<char*>(items.data()), static_cast<std::streamsize>(items.size() * sizeof(T)));
    return items;
}

/// The head of the file: everything that must agree, in the machine's own byte order and layout.
struct Head {
    std::array<char, 8> magic{'s', 'c', 'r', 'e', 'e', 'c', 'k', '4'};
    uint64_t scene_hash, seed, pixel_bytes = sizeof(Pixel), halves; ///< halves: how many pixels have them
    std::array<int32_t, 6> window;

    Head(const Film& film, const CheckpointKey& key)
        : scene_hash(key.scene_hash), seed(key.seed),
          halves(film.halves().size()), window{film.width(), film.height(), film.x0(), film.y0(), film.x1(), film.y1()}
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
    write_all(out, film.pixels());
    write_all(out, film.halves());
    write_all(out, film.tile_states().tiles);
    for (const uint32_t* x : {&film.tile_states().done, &film.tile_states().level})
        out.write(reinterpret_cast<const char*>(x), sizeof *x);
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
        throw InputError(path.string(), "no checkpoint of this version", "a checkpoint",
                         "remove it, or render without --resume");
    }
    if (std::memcmp(&found, &expected, sizeof found) != 0) {
        throw InputError(path.string(),
                         "a checkpoint of another picture (scene, input, seed, size, crop or --error differ)",
                         "one of this picture", "remove it, or render without --resume");
    }
    std::vector<Pixel> pixels = read_all(in, film.pixels());
    std::vector<PixelHalves> halves = read_all(in, film.halves());
    TileStates states;
    states.tiles = read_all(in, film.tile_states().tiles);
    for (uint32_t* x : {&states.done, &states.level}) in.read(reinterpret_cast<char*>(x), sizeof *x);
    if (!in)
        throw InputError(path.string(), "a checkpoint that ends early", "a complete one",
                         "remove it, or render without --resume");
    film.pixels() = std::move(pixels);
    film.halves() = std::move(halves);
    film.tile_states() = std::move(states);
}

} // namespace scree
