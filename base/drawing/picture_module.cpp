#include "base/drawing/picture_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>

bool scree_can_write_picture(const char* path)
{
    const auto out = OIIO::ImageOutput::create(path);
    return out && out->supports("ioproxy");
}

bool scree_encode_picture(const char* path, int width, int height, const float* rgb, std::string& bytes,
                          std::string& error)
{
    const auto out = OIIO::ImageOutput::create(path);
    if (!out) {
        error = OIIO::geterror();
        return false;
    }
    OIIO::Filesystem::IOVecOutput memory;
    const OIIO::ImageSpec spec(width, height, 3, OIIO::TypeUInt8);
    if (!out->set_ioproxy(&memory) || !out->open(path, spec) || !out->write_image(OIIO::TypeFloat, rgb) ||
        !out->close()) {
        error = out->geterror();
        return false;
    }
    bytes.assign(reinterpret_cast<const char*>(memory.buffer().data()), memory.buffer().size());
    return true;
}

bool scree_read_picture(const char* path, scree::PictureFile& picture, std::string& error)
{
    OIIO::ImageBuf image(path);
    if (!image.read(0, 0, true, OIIO::TypeFloat)) {
        error = image.geterror();
        return false;
    }
    const OIIO::ImageSpec& spec = image.spec();
    picture.width = static_cast<size_t>(spec.width);
    picture.height = static_cast<size_t>(spec.height);
    picture.channels = static_cast<size_t>(spec.nchannels);
    picture.full_width = static_cast<size_t>(spec.full_width);
    picture.full_height = static_cast<size_t>(spec.full_height);
    picture.whole = spec.x == spec.full_x && spec.y == spec.full_y && spec.width == spec.full_width &&
                    spec.height == spec.full_height;
    picture.eight_bit = image.nativespec().format == OIIO::TypeUInt8;
    if (!picture.whole) return true;
    picture.values.resize(picture.width * picture.height * picture.channels);
    if (image.get_pixels(image.roi(), OIIO::TypeFloat, picture.values.data())) return true;
    error = image.geterror();
    return false;
}
