#include "ingest/particles/csv_points.h"

#include "base/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace scree {

void write_csv_points(const ParticleFrame& frame, const std::filesystem::path& path)
{
    const auto fail = [&] { throw InputError(path.string(), std::strerror(errno), "a file that can be written"); };
    const auto close = [](std::FILE* open_file) { return std::fclose(open_file); };
    std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "wb"), close);
    if (!file) fail();

    constexpr size_t flush_at = size_t{1} << 20;
    fmt::memory_buffer text;
    const auto flush = [&] {
        if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size()) fail();
        text.clear();
    };
    const auto out = std::back_inserter(text);
    const bool turned = !frame.orientation.empty();
    fmt::format_to(out, "id,type,x,y,z,radius{}\n", turned ? ",quatw,quati,quatj,quatk" : "");
    for (size_t i = 0; i < frame.size(); ++i) {
        const Imath::V3d& p = frame.position[i];
        fmt::format_to(out, "{},{},{},{},{},{}", frame.id[i], frame.type[i], p.x, p.y, p.z, frame.radius[i]);
        if (turned) {
            const Imath::Quatf& q = frame.orientation[i];
            fmt::format_to(out, ",{},{},{},{}", q.r, q.v.x, q.v.y, q.v.z);
        }
        text.push_back('\n');
        if (text.size() > flush_at) flush();
    }
    flush();
    if (std::fclose(file.release()) != 0) fail();
}

} // namespace scree
