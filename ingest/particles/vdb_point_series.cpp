#include "ingest/particles/vdb_point_series.h"

#include "base/error.h"
#include "ingest/particles/vdb_points.h"

#include <fmt/format.h>

namespace scree {

namespace {

class VdbPointSeries final : public ParticleSeries {
public:
    VdbPointSeries(std::string pattern, std::vector<std::filesystem::path> files)
        : pattern_(std::move(pattern)), files_(std::move(files))
    {
    }

    size_t frame_count() const override { return files_.size(); }
    int64_t step(size_t frame) const override { return read(frame).step; }
    uint64_t particle_count(size_t frame) const override { return read(frame).size(); }
    const std::vector<std::string>& columns(size_t frame) const override
    {
        file(frame);
        return none_;
    }
    bool has_radius(size_t frame) const override
    {
        file(frame);
        return true;
    }
    const std::vector<std::string>& type_names() const override { return none_; }
    const std::filesystem::path& file(size_t frame) const override
    {
        if (frame < files_.size()) return files_[frame];
        throw InputError(pattern_, fmt::format("frame {}", frame),
                         files_.size() == 1 ? "frame 0, the only one"
                                            : fmt::format("a frame from 0 to {}", files_.size() - 1));
    }
    const std::vector<std::string>& warnings() const override { return none_; }
    ParticleFrame read(size_t frame, const ParticleReadOptions& = {}, const Progress& = {}) const override
    {
        return read_vdb_points(file(frame));
    }

private:
    std::string pattern_;
    std::vector<std::filesystem::path> files_;
    std::vector<std::string> none_;
};

} // namespace

bool is_start_of_vdb(std::string_view start) { return start.starts_with(std::string_view(" BDV\0\0\0\0", 8)); }

std::unique_ptr<ParticleSeries> open_vdb_points(const std::string& pattern,
                                                const std::vector<std::filesystem::path>& files, const Progress&)
{
    return std::make_unique<VdbPointSeries>(pattern, files);
}

} // namespace scree
