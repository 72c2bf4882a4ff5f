// The cache of precomputed scattering: one computation serves every colour, absorption and size; damage is noticed.

#include "base/error.h"
#include "render/gsdf/gsdf_cache.h"
#include "render/gsdf/gsdf_file.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/builders/test_files.h"

#include <gtest/gtest.h>

#include <fstream>

namespace scree {
namespace {

class GsdfCache : public testing::Test {
protected:
    FoundGsdf find(const Material& material, double error = 0.3, uint64_t shape = 7)
    {
        GsdfSource source{shape, material, [this] {
                              ++traced_;
                              return body_;
                          }};
        return find_gsdf(source, {error}, folder_.path() / "cache");
    }

    static inline const EmbreeDevice device_;
    std::shared_ptr<const Exemplar> body_ = std::make_shared<Exemplar>(device_, cube(), "cube");
    test::TemporaryFolder folder_;
    int traced_ = 0;
};

TEST_F(GsdfCache, OneComputationServesColourAbsorptionAndTint)
{
    Material glass = dielectric(1.5);
    EXPECT_TRUE(find(glass).computed);
    for (const float absorption : {0.0f, 0.1f, 30.0f}) {
        for (const float tint : {1.0f, 0.5f}) {
            glass.absorption = Color(absorption, 0, 1);
            glass.tint = Color(1, tint, 1);
            EXPECT_FALSE(find(glass).computed);
        }
    }
    EXPECT_TRUE(find(lambert(0.2f)).computed);
    EXPECT_FALSE(find(lambert(0.9f)).computed);
    EXPECT_EQ(traced_, 2);
}

TEST_F(GsdfCache, WhatDecidesScatteringIsTracedAnew)
{
    find(dielectric(1.5));
    EXPECT_TRUE(find(dielectric(1.31)).computed);
    EXPECT_TRUE(find(dielectric(1.5, 0.2)).computed);
    EXPECT_TRUE(find(dielectric(1.5), 0.3, 8).computed);
    EXPECT_TRUE(find(dielectric(1.5), 0.25).computed) << "pictures do not depend on what else was traced";
    EXPECT_FALSE(find(dielectric(1.5), 0.3).computed);
    EXPECT_EQ(traced_, 5);
}

TEST_F(GsdfCache, DamageIsNoticedAndMended)
{
    const FoundGsdf first = find(dielectric(1.5));
    const std::string good = test::read_bytes(first.file);
    ASSERT_GT(good.size(), 100000u);
    const auto rewrite = [&](const std::string& bytes) { std::ofstream(first.file, std::ios::binary) << bytes; };
    std::vector<std::string> broken{"", good.substr(0, 50), good.substr(0, good.size() / 2), good + "x",
                                    std::string(good.size(), 'x')};
    for (size_t at = 0; at < good.size(); at += good.size() / 23) {
        broken.push_back(good);
        broken.back()[at] = static_cast<char>(broken.back()[at] ^ 0x10);
    }
    for (const std::string& bytes : broken) {
        rewrite(bytes);
        EXPECT_THROW(read_gsdf(first.file), InputError);
    }
    rewrite(broken.back());
    const FoundGsdf again = find(dielectric(1.5));
    EXPECT_TRUE(again.computed);
    EXPECT_NE(again.remark.find("made again"), std::string::npos) << again.remark;
    EXPECT_FALSE(find(dielectric(1.5)).computed);
    EXPECT_EQ(test::read_bytes(first.file).size(), good.size());
}

TEST_F(GsdfCache, WithoutAFolderItIsMadeForThisRun)
{
    GsdfSource source{0, lambert(1), nullptr};
    EXPECT_TRUE(find_gsdf(source, {0.3}, {}).computed);
    std::ofstream(folder_.path() / "file") << "in the way";
    const FoundGsdf found = find_gsdf(source, {0.3}, folder_.path() / "file" / "cache");
    EXPECT_TRUE(found.gsdf);
    EXPECT_NE(found.remark.find("not kept"), std::string::npos) << found.remark;
}

TEST_F(GsdfCache, CancelledLeavesNothing)
{
    Progress progress;
    progress.cancel();
    EXPECT_THROW(find_gsdf({0, lambert(1), nullptr}, {0.3}, folder_.path() / "cache", progress), Cancelled);
    EXPECT_FALSE(stored_gsdf({0, lambert(1), nullptr}, {0.3}, folder_.path() / "cache").gsdf);
}

} // namespace
} // namespace scree
