#include "base/drawing/picture_file.h"

#include "base/atomic_file.h"
#include "base/drawing/picture_module.h"
#include "base/error.h"
#include "base/program_folder.h"

#include <dlfcn.h>

#include <fstream>
#include <string>

namespace scree {

namespace {

/// The functions of scree_pictures.so.
struct PictureModule {
    decltype(&scree_can_write_picture) can_write;
    decltype(&scree_encode_picture) encode;
    decltype(&scree_read_picture) read;
};

PictureModule load_module()
{
    const std::filesystem::path file = folder_of_this_program() / "scree_pictures.so";
    // Never closed: OpenImageIO keeps threads and caches until the program ends.
    void* const library = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
    const auto function = [&]<typename F>(F*& to, const char* name) {
        to = library ? reinterpret_cast<F*>(dlsym(library, name)) : nullptr;
        if (to) return;
        const char* const why = dlerror();
        throw InputError(file.string(), why ? why : "no " + std::string(name),
                         "the part of scree that reads and writes pictures",
                         "it is built with scree and must stay in scree's folder; it needs OpenImageIO");
    };
    PictureModule module{};
    function(module.can_write, "scree_can_write_picture");
    function(module.encode, "scree_encode_picture");
    function(module.read, "scree_read_picture");
    return module;
}

const PictureModule& module()
{
    static const PictureModule loaded = load_module(); // tried again after a throw
    return loaded;
}

} // namespace

PictureFile read_picture_file(const std::filesystem::path& path)
{
    PictureFile picture;
    std::string error;
    if (!module().read(path.c_str(), picture, error)) {
        throw InputError(path.string(), error, "a picture OpenImageIO can read (EXR, HDR, PNG, ...)");
    }
    return picture;
}

bool can_write_picture_file(const std::filesystem::path& path) { return module().can_write(path.c_str()); }

std::string encode_picture(const std::filesystem::path& name, int width, int height, std::span<const float> rgb)
{
    std::string bytes, error;
    if (!module().encode(name.c_str(), width, height, rgb.data(), bytes, error)) {
        throw InputError(name.string(), error, "a picture that the format can hold");
    }
    return bytes;
}

void write_picture_file(const std::filesystem::path& path, int width, int height, std::span<const float> rgb)
{
    // Encoded in memory first: on a full disk the PNG writer reports nothing, and the JPEG library ends the program.
    const std::string bytes = encode_picture(path, width, height, rgb);
    AtomicFile file(path);
    std::ofstream out(file.temporary(), std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out)
        throw InputError(path.string(), "a disk that is full or cannot be written",
                         "enough free space for the picture");
    file.commit();
}

} // namespace scree
