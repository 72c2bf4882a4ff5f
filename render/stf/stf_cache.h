#pragma once

#include "render/stf/stf_builder.h"

#include <filesystem>
#include <map>
#include <string>

namespace scree {

/// Finds shell transport functions by their phase function: among those of this run, in a folder, or makes new ones.
class StfCache {
public:
    /// folder: where they are kept for the next run; empty: they are not kept.
    explicit StfCache(std::filesystem::path folder, const StfOptions& options = {})
        : folder_(std::move(folder)), options_(options)
    {
    }

    struct Found {
        std::shared_ptr<const Stf> stf;
        size_t computed = 0; ///< number of shells made now: the largest ones
        std::vector<double> seconds; ///< that each of these took
        std::string remark; ///< why stored shells were not used, or why shells could not be stored; may be empty
    };
    /// At least `shells` shells of the phase function: the table if it is not null, else Henyey and Greenstein's of
    /// mean cosine g. Throws Cancelled.
    Found find(double g, const std::shared_ptr<const PhaseTable>& table, size_t shells, const Progress& progress);

private:
    uint64_t key(double g, const PhaseTable* table) const;
    std::filesystem::path file(uint64_t key) const;

    std::filesystem::path folder_;
    StfOptions options_;
    std::map<uint64_t, std::shared_ptr<const Stf>> known_;
};

} // namespace scree
