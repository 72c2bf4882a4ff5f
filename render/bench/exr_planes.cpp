#include "render/bench/exr_planes.h"

#include "base/atomic_file.h"
#include "base/error.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

namespace scree {

namespace {

Imf::FrameBuffer frame_buffer(ExrPlanes& picture)
{
    Imf::FrameBuffer buffer;
    for (auto& [name, plane] : picture.planes) {
        buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(plane.data()), sizeof(float),
                                       sizeof(float) * static_cast<size_t>(picture.width)));
    }
    return buffer;
}

} // namespace

void write_exr_planes(const std::filesystem::path& path, const ExrPlanes& picture)
{
    AtomicFile file(path);
    try {
        Imf::Header header(picture.width, picture.height);
        header.compression() = Imf::ZIP_COMPRESSION;
        for (const auto& [key, text] : picture.texts) header.insert(key, Imf::StringAttribute(text));
        for (const auto& [key, number] : picture.numbers) header.insert(key, Imf::DoubleAttribute(number));
        for (const auto& item : picture.planes) header.channels().insert(item.first, Imf::Channel(Imf::FLOAT));
        Imf::OutputFile out(file.temporary().c_str(), header);
        ExrPlanes copy{picture.width, picture.height, picture.planes, {}, {}}; // OpenEXR takes non-const pointers
        out.setFrameBuffer(frame_buffer(copy));
        out.writePixels(picture.height);
    } catch (const std::exception& error) {
        throw InputError(path.string(), error.what(), "a file that can be written");
    }
    file.commit();
}

ExrPlanes read_exr_planes(const std::filesystem::path& path)
{
    ExrPlanes picture;
    try {
        Imf::InputFile in(path.c_str());
        const Imf::Header& header = in.header();
        const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
        if (data != display || data.min != Imath::V2i(0, 0)) {
            throw InputError(path.string(), "a crop, or a picture that does not begin at 0,0", "a whole picture");
        }
        picture.width = data.max.x + 1;
        picture.height = data.max.y + 1;
        const size_t pixels = static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height);
        for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
            if (it.channel().xSampling == 1 && it.channel().ySampling == 1) picture.planes[it.name()].resize(pixels);
        }
        for (auto it = header.begin(); it != header.end(); ++it) {
            if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute()))
                picture.texts[it.name()] = text->value();
            if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&it.attribute()))
                picture.numbers[it.name()] = number->value();
            if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&it.attribute()))
                picture.numbers[it.name()] = number->value();
        }
        in.setFrameBuffer(frame_buffer(picture));
        in.readPixels(0, picture.height - 1);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(path.string(), error.what(), "an EXR picture");
    }
    return picture;
}

} // namespace scree
