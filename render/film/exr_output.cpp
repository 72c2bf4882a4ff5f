#include "render/film/exr_output.h"

#include "base/atomic_file.h"
#include "base/error.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <functional>

namespace scree {

namespace {

/// Channels being collected: planes of 32-bit values in the order of the data window.
class Channels {
public:
    explicit Channels(const Film& film) : film_(film) {}

    void add(const std::string& name, const std::function<float(const Pixel&)>& value)
    {
        auto& plane = floats_[name];
        plane.reserve(film_.pixels().size());
        for (const Pixel& pixel : film_.pixels()) plane.push_back(value(pixel));
    }
    void add_integer(const std::string& name, const std::function<uint32_t(const Pixel&)>& value)
    {
        auto& plane = integers_[name];
        plane.reserve(film_.pixels().size());
        for (const Pixel& pixel : film_.pixels()) plane.push_back(value(pixel));
    }
    void add_rgb(const std::string& prefix, const std::function<Color(const Pixel&)>& value)
    {
        const char* names[] = {"R", "G", "B"};
        for (int c = 0; c < 3; ++c) add(prefix + names[c], [&](const Pixel& pixel) { return value(pixel)[c]; });
    }

    void declare(Imf::Header& header) const
    {
        for (const auto& item : floats_) header.channels().insert(item.first, Imf::Channel(Imf::FLOAT));
        for (const auto& item : integers_) header.channels().insert(item.first, Imf::Channel(Imf::UINT));
    }
    Imf::FrameBuffer frame_buffer() const
    {
        Imf::FrameBuffer buffer;
        const size_t row = 4 * static_cast<size_t>(film_.x1() - film_.x0());
        const auto insert = [&](const std::string& name, const void* data, Imf::PixelType type) {
            // OpenEXR wants the address that pixel (0, 0) of the display window would have.
            auto* base = const_cast<char*>(static_cast<const char*>(data));
            base -= static_cast<std::ptrdiff_t>(film_.x0()) * 4 +
                    static_cast<std::ptrdiff_t>(film_.y0()) * static_cast<std::ptrdiff_t>(row);
            buffer.insert(name, Imf::Slice(type, base, 4, row));
        };
        for (const auto& item : floats_) insert(item.first, item.second.data(), Imf::FLOAT);
        for (const auto& item : integers_) insert(item.first, item.second.data(), Imf::UINT);
        return buffer;
    }

private:
    const Film& film_;
    std::map<std::string, std::vector<float>> floats_;
    std::map<std::string, std::vector<uint32_t>> integers_;
};

Channels collect(const Film& film, const std::vector<Aov>& aov, double depth_scale)
{
    Channels channels(film);
    channels.add_rgb("", [](const Pixel& p) { return p.mean(); });
    for (const Aov which : aov) {
        switch (which) {
        case Aov::albedo:
            channels.add_rgb("albedo.",
                             [](const Pixel& p) { return p.albedo / static_cast<float>(std::max(1u, p.samples)); });
            break;
        case Aov::normal: {
            const char* names[] = {"N.X", "N.Y", "N.Z"};
            for (int c = 0; c < 3; ++c) {
                channels.add(names[c],
                             [c](const Pixel& p) { return p.normal[c] / static_cast<float>(std::max(1u, p.hits)); });
            }
            break;
        }
        case Aov::depth:
            channels.add(
                "Z", [&](const Pixel& p) { return static_cast<float>(depth_scale * p.depth / std::max(1u, p.hits)); });
            break;
        case Aov::type: channels.add_integer("type", [](const Pixel& p) { return p.type; }); break;
        case Aov::id: channels.add_integer("id", [](const Pixel& p) { return p.id; }); break;
        case Aov::variance: channels.add_rgb("variance.", [](const Pixel& p) { return p.variance(); }); break;
        case Aov::samples: channels.add_integer("samples", [](const Pixel& p) { return p.samples; }); break;
        }
    }
    return channels;
}

} // namespace

void write_exr(const std::filesystem::path& path, const Film& film, const std::vector<Aov>& aov,
               const PictureMetadata& metadata)
{
    using Imath::Box2i;
    using Imath::V2i;
    AtomicFile file(path);
    try {
        Imf::Header header(Box2i(V2i(0, 0), V2i(film.width() - 1, film.height() - 1)),
                           Box2i(V2i(film.x0(), film.y0()), V2i(film.x1() - 1, film.y1() - 1)));
        header.compression() = Imf::ZIP_COMPRESSION;
        for (const auto& [key, text] : metadata.texts) header.insert(key, Imf::StringAttribute(text));
        for (const auto& [key, number] : metadata.numbers)
            header.insert(key, Imf::FloatAttribute(static_cast<float>(number)));
        header.insert("worldToCamera", Imf::M44fAttribute(Imath::M44f(metadata.world_to_camera)));
        header.insert("worldToNDC", Imf::M44fAttribute(Imath::M44f(metadata.world_to_ndc)));
        header.insert("chromaticities", Imf::ChromaticitiesAttribute(Imf::Chromaticities())); // Rec. 709
        const Channels channels = collect(film, aov, metadata.depth_scale);
        channels.declare(header);
        Imf::OutputFile out(file.temporary().c_str(), header);
        out.setFrameBuffer(channels.frame_buffer());
        out.writePixels(film.y1() - film.y0());
    } catch (const std::exception& error) {
        throw InputError(path.string(), error.what(), "a file that can be written");
    }
    file.commit();
}

} // namespace scree
