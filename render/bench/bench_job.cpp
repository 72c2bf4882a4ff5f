#include "render/bench/bench_job.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace scree {

namespace {

/// The positions in `names` of the comma-separated names in `text`.
std::vector<size_t> places_of(const std::string& text, const std::vector<std::string>& names, const std::string& option)
{
    std::vector<size_t> places;
    std::istringstream in(text);
    for (std::string word; std::getline(in, word, ',');) {
        const auto it = std::ranges::find(names, word);
        if (it == names.end())
            throw InputError(
                option, "'" + word + "'",
                fmt::format("names from {}, separated by commas{}", fmt::join(names, ", "), did_you_mean(word, names)));
        const auto place = static_cast<size_t>(it - names.begin());
        if (std::ranges::find(places, place) != places.end())
            throw InputError(option, "'" + word + "' twice", "every name once");
        places.push_back(place);
    }
    if (places.empty()) throw InputError(option, "nothing", fmt::format("names from {}", fmt::join(names, ", ")));
    return places;
}

} // namespace

std::vector<BenchMethod> parse_methods(const std::string& integrators, const std::string& accuracies)
{
    std::vector<size_t> levels;
    if (!accuracies.empty()) levels = places_of(accuracies, accuracy_names, "--accuracy");
    std::vector<BenchMethod> methods;
    bool has_auto = false;
    for (const size_t place : places_of(integrators, integrator_names, "--integrators")) {
        const auto kind = static_cast<IntegratorKind>(place);
        has_auto = has_auto || kind == IntegratorKind::automatic;
        if (kind != IntegratorKind::automatic || levels.empty()) {
            methods.push_back({integrator_names[place], kind, std::nullopt});
            continue;
        }
        for (const size_t level : levels) {
            methods.push_back({"auto " + accuracy_names[level], kind, static_cast<Accuracy>(level)});
        }
    }
    if (!levels.empty() && !has_auto)
        throw InputError("--accuracy", accuracies, "auto among the integrators: the others have no accuracy",
                         "add auto to --integrators, or leave --accuracy out");
    return methods;
}

RenderJob render_job_of(const BenchJob& job, const BenchMethod& method)
{
    RenderJob render = job.scene;
    if (method.integrator) render.integrator = method.integrator;
    if (method.accuracy) render.accuracy = method.accuracy;
    return render;
}

} // namespace scree
