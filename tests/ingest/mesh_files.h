#pragma once

#include "base/error.h"
#include "ingest/meshes/triangle_mesh.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <functional>

namespace scree::test {

using Imath::V3d;

/// A folder for the test alone, removed at its end.
class MeshFiles : public testing::Test {
protected:
    void SetUp() override
    {
        folder_ =
            std::filesystem::temp_directory_path() /
            fmt::format("scree_mesh_{}_{}", getpid(), testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& name, const std::string& content) const
    {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return folder_ / name;
    }
    TriangleMesh read(const std::string& name, const std::string& content) const
    {
        return read_mesh(write(name, content));
    }

    /// What the error says after the folder; fails the test if there is none.
    std::string error_of(const std::filesystem::path& path) const
    {
        try {
            read_mesh(path);
        } catch (const InputError& error) {
            const std::string text = error.what(), start = folder_.string() + "/";
            return text.starts_with(start) ? text.substr(start.size()) : text;
        }
        ADD_FAILURE() << path << " was read";
        return "";
    }
    std::string error_of(const std::string& name, const std::string& content) const
    {
        return error_of(write(name, content));
    }

    const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
};

/// A box of 2 x 3 x 4 far from the origin, as six quadrilaterals that face outward.
inline const std::vector<V3d> box_corners = {{10, 20, 30}, {12, 20, 30}, {12, 23, 30}, {10, 23, 30},
                                             {10, 20, 34}, {12, 20, 34}, {12, 23, 34}, {10, 23, 34}};
inline const std::vector<std::array<uint32_t, 4>> box_faces = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                               {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

// The same box in every format.

/// corner: how a vertex, counted from 0, is written.
std::string box_obj(const std::function<std::string(uint32_t)>& corner);
std::string box_off();
std::string box_off_binary();
std::string box_ply_header(const char* format, const char* index_type);
std::string box_ply();
std::string box_stl(bool upper);
std::string box_stl_binary(const std::string& title);

template <typename T>
std::string bytes(T value, std::endian order)
{
    std::string raw(sizeof(T), '\0');
    std::memcpy(raw.data(), &value, sizeof(T));
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    return raw;
}

template <typename Index>
std::string box_ply_binary(std::endian order, const char* index_type)
{
    std::string content =
        box_ply_header(order == std::endian::big ? "binary_big_endian" : "binary_little_endian", index_type);
    for (const V3d& p : box_corners) {
        for (int axis = 0; axis < 3; ++axis) content += bytes(p[axis], order);
        content += '\x7f';
    }
    for (const auto& face : box_faces) {
        content += '\4';
        for (const uint32_t vertex : face) content += bytes(static_cast<Index>(vertex), order);
    }
    return content;
}

} // namespace scree::test
