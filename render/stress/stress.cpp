#include "render/stress/stress.h"

#include "base/error.h"
#include "render/build/part_report.h"
#include "render/stress/stress_run.h"

namespace scree {

void StressRun::begin(const std::string& name, const std::string& compared, const std::string& why)
{
    report_.families.push_back({name, compared, why, {}});
}

void StressRun::add(const std::string& name, StressExtent extent, const std::function<StressFinding()>& find)
{
    StressFamily& family = report_.families.back();
    if (options_.quick && extent != StressExtent::quick) return;
    if ((family.name + ": " + name).find(options_.only) == std::string::npos) return;
    if (progress_.cancelled()) throw Cancelled();
    const Stopwatch watch;
    StressCase done;
    done.name = name;
    try {
        done.finding = find();
    } catch (const InputError& error) {
        done.error = error.what();
    }
    done.seconds = watch.seconds();
    report_.seconds += done.seconds;
    family.cases.push_back(std::move(done));
}

std::string name_of(IntegratorKind kind) { return integrator_names[kind]; }

StressReport run_stress(const StressOptions& options, const Progress& progress)
{
    StressRun run(options, progress);
    add_scale_cases(run);
    add_place_cases(run);
    add_turn_cases(run);
    add_size_cases(run);
    add_glass_cases(run);
    add_medium_cases(run);
    add_packing_cases(run);
    add_long_path_cases(run);
    add_furnace_cases(run);
    return run.take();
}

} // namespace scree
