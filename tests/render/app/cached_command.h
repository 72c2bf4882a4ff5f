#pragma once

#include "tests/builders/test_files.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace scree::test {

/// A test of the built program, with its own folder and its own cache.
class CachedCommand : public testing::Test {
protected:
    CachedCommand()
    {
        std::filesystem::create_directory(folder_.path("cache"));
        setenv("SCREE_CACHE", folder_.path("cache").c_str(), 1);
    }
    ~CachedCommand() override { unsetenv("SCREE_CACHE"); }

    std::string path(const std::string& name) const { return folder_.path(name).string(); }
    /// The files of the cache.
    std::vector<std::filesystem::path> stored() const
    {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path("cache")))
            files.push_back(entry.path());
        return files;
    }

    TemporaryFolder folder_;
};

} // namespace scree::test
