#include "mixtures/type_table.h"

#include "base/error.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/AttributeArray.h>
#include <openvdb/points/PointDataGrid.h>

#include <map>

namespace scree {

namespace {

namespace points = openvdb::points;
using Leaf = points::PointDataTree::LeafNodeType;

points::PointDataGrid::Ptr read_points(const std::string& place)
{
    openvdb::io::File file(place);
    file.open();
    for (auto name = file.beginName(); name != file.endName(); ++name) {
        const auto grid = openvdb::gridPtrCast<points::PointDataGrid>(file.readGrid(name.gridName()));
        if (grid) return grid;
    }
    throw InputError(place, "no grid of points", "a PointDataGrid with an int32 attribute of types");
}

template <class T>
void append_ids(const Leaf& leaf, size_t position, const std::string& place, TypeTable& table)
{
    const points::AttributeHandle<T> ids(leaf.constAttributeArray(position));
    for (auto i = leaf.beginIndexAll(); i; ++i) {
        const T id = ids.get(*i);
        if (id < 0) throw InputError(place, fmt::format("id {}", id), "ids that are not below 0");
        table.ids.push_back(static_cast<uint64_t>(id));
    }
}

} // namespace

TypeTable read_vdb_types(const std::filesystem::path& path, const std::string& type, const std::string& id)
{
    openvdb::initialize();
    const std::string place = path.string();
    try {
        const points::PointDataGrid::Ptr grid = read_points(place);
        TypeTable table;
        std::map<int32_t, uint16_t> codes;
        auto met = codes.end(); // neighbours often share their type
        for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) {
            const auto& descriptor = leaf->attributeSet().descriptor();
            const size_t types_at = descriptor.find(type), ids_at = descriptor.find(id);
            if (types_at == points::AttributeSet::INVALID_POS ||
                leaf->constAttributeArray(types_at).valueType() != "int32")
                throw InputError(place, "points without an int32 attribute " + type,
                                 "the type of each point as int32 " + type,
                                 "\"column\" says which attribute holds the types");
            const points::AttributeHandle<int32_t> types(leaf->constAttributeArray(types_at));
            for (auto i = leaf->beginIndexAll(); i; ++i) {
                const int32_t number = types.get(*i);
                if (met == codes.end() || met->first != number) met = codes.find(number);
                if (met == codes.end()) {
                    if (table.words.size() == 65535)
                        throw InputError(place, "more than 65535 different types", "an attribute of types");
                    met = codes.emplace(number, static_cast<uint16_t>(table.words.size())).first;
                    table.words.push_back(std::to_string(number));
                }
                table.code.push_back(met->second);
            }
            if (ids_at == points::AttributeSet::INVALID_POS) continue;
            const std::string kind = leaf->constAttributeArray(ids_at).valueType();
            if (kind == "int64")
                append_ids<int64_t>(*leaf, ids_at, place, table);
            else if (kind == "int32")
                append_ids<int32_t>(*leaf, ids_at, place, table);
            else
                throw InputError(place, "ids of type " + kind, "an int64 or int32 attribute " + id);
        }
        if (!table.ids.empty() && table.ids.size() != table.code.size())
            throw InputError(place, "ids of some points only", "an id for every point, or for none");
        return table;
    } catch (const openvdb::Exception& failure) {
        throw InputError(place, failure.what(), "an OpenVDB file of points");
    }
}

} // namespace scree
