#include "ingest/particles/vdb_point_stream.h"

#include "base/error.h"
#include "ingest/particles/vdb_point_grid.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <fstream>

namespace scree {

namespace {

/// Writes one grid after another: OpenVDB's own writers need all grids at once, but the functions that write the parts
/// of the format are protected members of Archive.
class GrowingArchive : public openvdb::io::Archive {
public:
    Ptr copy() const override { return std::make_shared<GrowingArchive>(*this); }

    /// Writes the header with 0 grids; returns where in the file the number of grids is.
    std::streampos begin(std::ostream& out) const
    {
        writeHeader(out, true);
        openvdb::MetaMap().writeMeta(out);
        const std::streampos place = out.tellp();
        write_count(out, 0);
        return place;
    }
    void add(std::ostream& out, const openvdb::GridBase::ConstPtr& grid) const
    {
        openvdb::io::GridDescriptor descriptor(grid->getName(), grid->type(), grid->saveFloatAsHalf());
        writeGrid(descriptor, grid, out, true);
    }
    static void write_count(std::ostream& out, int32_t grids)
    {
        out.write(reinterpret_cast<const char*>(&grids), sizeof(grids));
    }
};

} // namespace

struct VdbPointStream::Impl {
    std::filesystem::path path;
    double voxel;
    std::ofstream out;
    GrowingArchive archive;
    std::streampos count_place;
    int32_t grids = 0;

    void check() const
    {
        if (!out) throw InputError(path.string(), "a disk that is full or cannot be written", "room for the points");
    }
    template <class Work>
    void write(const Work& work)
    {
        try {
            work();
        } catch (const openvdb::Exception& failure) {
            throw InputError(path.string(), failure.what(), "a file that can be written");
        }
        check();
    }
};

VdbPointStream::VdbPointStream(const std::filesystem::path& path, double voxel)
    : impl_(new Impl{path, voxel, {}, {}, {}})
{
    openvdb::initialize();
    impl_->out.open(path, std::ios::binary | std::ios::trunc);
    impl_->check();
    impl_->write([&] { impl_->count_place = impl_->archive.begin(impl_->out); });
}

VdbPointStream::~VdbPointStream() = default;

void VdbPointStream::add(const ParticleFrame& batch)
{
    const std::string name = impl_->grids == 0 ? "points" : "points_part_" + std::to_string(impl_->grids);
    const auto grid = make_point_grid(batch, name, impl_->path.string(), impl_->voxel);
    impl_->write([&] { impl_->archive.add(impl_->out, grid); });
    ++impl_->grids;
}

void VdbPointStream::finish()
{
    impl_->out.seekp(impl_->count_place);
    GrowingArchive::write_count(impl_->out, impl_->grids);
    impl_->out.close();
    impl_->check();
}

} // namespace scree
