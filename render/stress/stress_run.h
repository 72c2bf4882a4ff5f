#pragma once

#include "render/stress/stress.h"
#include "render/stress/stress_comparison.h"
#include "render/stress/stress_stage.h"

#include <functional>

namespace scree {

enum class StressExtent : uint8_t { quick, full };

/// Runs cases one after the other and keeps what they find.
class StressRun {
public:
    StressRun(const StressOptions& options, const Progress& progress) : options_(options), progress_(progress) {}

    /// Begins the family of the cases that follow.
    void begin(const std::string& name, const std::string& compared, const std::string& why);
    /// Runs the case if it is asked for; an InputError is kept as its result. Throws Cancelled.
    void add(const std::string& name, StressExtent extent, const std::function<StressFinding()>& find);

    /// What cases may show and stop on; their own stages are not shown.
    const Progress& progress() const { return progress_; }
    StressReport take() { return std::move(report_); }

private:
    const StressOptions& options_;
    const Progress& progress_;
    StressReport report_;
};

std::string name_of(IntegratorKind kind);

// The families, in order.
void add_scale_cases(StressRun& run);
void add_place_cases(StressRun& run);
void add_turn_cases(StressRun& run);
void add_size_cases(StressRun& run);
void add_glass_cases(StressRun& run);
void add_medium_cases(StressRun& run);
void add_packing_cases(StressRun& run);
void add_long_path_cases(StressRun& run);
void add_furnace_cases(StressRun& run);

} // namespace scree
