#pragma once

#include "render/stf/stf_builder.h"

#include <filesystem>
#include <map>
#include <string>

namespace scree {

/// Shell transport functions by their phase function: those of this run, those kept in a folder, or new ones.
class StfCache {
public:
    /// folder: empty where nothing is to be kept for the next run.
    explicit StfCache(std::filesystem::path folder, const StfOptions& options = {})
        : folder_(std::move(folder)), options_(options)
    {
    }

    struct Found {
        std::shared_ptr<const Stf> stf;
        size_t computed = 0; ///< shells that were made now, the last of them
        std::vector<double> seconds; ///< that each of those took
        std::string remark; ///< why stored ones were not used, or could not be stored; may be empty
    };
    /// At least `shells` shells of g, or of a table if there is one. Throws Cancelled.
    Found find(double g, const std::shared_ptr<const PhaseTable>& table, size_t shells, const Progress& progress);

private:
    uint64_t key(double g, const PhaseTable* table) const;
    std::filesystem::path file(uint64_t key) const;

    std::filesystem::path folder_;
    StfOptions options_;
    std::map<uint64_t, std::shared_ptr<const Stf>> known_;
};

} // namespace scree
