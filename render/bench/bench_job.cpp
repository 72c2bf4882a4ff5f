#include "render/bench/bench_job.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace scree {

namespace {

/// The values of comma-separated names.
template <class E>
std::vector<E> values_of(const std::string& text, const EnumNames<E>& names, const std::string& option)
{
    const std::string expected = fmt::format("names of {}", fmt::join(names.words(), ", "));
    std::vector<E> values;
    std::istringstream in(text);
    for (std::string word; std::getline(in, word, ',');) {
        const std::optional<E> value = names.find(word);
        if (!value)
            throw InputError(option, "'" + word + "'",
                             expected + ", separated by commas" + did_you_mean(word, names.words()));
        if (std::ranges::find(values, *value) != values.end())
            throw InputError(option, "'" + word + "' twice", "every name once");
        values.push_back(*value);
    }
    if (values.empty()) throw InputError(option, "nothing", expected);
    return values;
}

} // namespace

BenchMethod bench_method(IntegratorKind kind, std::optional<Accuracy> accuracy)
{
    BenchMethod method{integrator_names[kind], switch_overrides("--integrator", integrator_names[kind])};
    if (!accuracy) return method;
    method.name += " " + accuracy_names[*accuracy];
    for (const SceneOverride& value : switch_overrides("--accuracy", accuracy_names[*accuracy]))
        method.switches.push_back(value);
    return method;
}

std::vector<BenchMethod> parse_methods(const std::string& integrators, const std::string& accuracies)
{
    std::vector<Accuracy> levels;
    if (!accuracies.empty()) levels = values_of(accuracies, accuracy_names, "--accuracy");
    std::vector<BenchMethod> methods;
    bool has_auto = false;
    for (const IntegratorKind kind : values_of(integrators, integrator_names, "--integrators")) {
        has_auto = has_auto || kind == IntegratorKind::automatic;
        if (kind != IntegratorKind::automatic || levels.empty()) {
            methods.push_back(bench_method(kind));
            continue;
        }
        for (const Accuracy level : levels) methods.push_back(bench_method(kind, level));
    }
    if (!levels.empty() && !has_auto)
        throw InputError("--accuracy", accuracies, "auto among the integrators: the others have no accuracy",
                         "add auto to --integrators, or leave --accuracy out");
    return methods;
}

RenderJob render_job_of(const BenchJob& job, const BenchMethod& method)
{
    RenderJob render = job.scene;
    render.switches.insert(render.switches.end(), method.switches.begin(), method.switches.end());
    return render;
}

} // namespace scree
