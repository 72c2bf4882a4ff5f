#include "render/bench/bench_suite.h"

#include "base/error.h"
#include "base/json.h"

#include <fmt/format.h>

#include <algorithm>

namespace scree {

namespace {

/// A JSON array of names in the form of the command line, separated by commas.
std::string names_of(const JsonValue& json, const std::vector<std::string>& allowed)
{
    std::vector<std::string> names;
    for (const JsonValue& item : json.array(1)) names.push_back(allowed[item.choice(allowed)]);
    return fmt::format("{}", fmt::join(names, ","));
}

BenchJob read_job(const JsonValue& json, double scale)
{
    JsonObject object = json.object();
    BenchJob job;
    const JsonValue name = object.require("name");
    job.title = name.string();
    const bool plain =
        std::ranges::all_of(job.title, [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_'; });
    if (job.title.empty() || !plain) name.fail("letters, digits, - and _: files are named after it");
    job.scene.scene = object.require("scene").path().lexically_normal();
    if (const auto frame = object.find("frame")) job.frame = static_cast<size_t>(frame->integer(0, 1000000000));
    if (const auto size = object.find("size")) {
        const auto sides = size->array(2, 2);
        job.scene.set("--size", fmt::format("{}x{}", sides[0].integer(1, 65536), sides[1].integer(1, 65536)));
    }
    std::string integrators = "auto,ept", accuracy;
    if (const auto value = object.find("integrators")) integrators = names_of(*value, integrator_names.words());
    if (const auto value = object.find("accuracy")) accuracy = names_of(*value, accuracy_names.words());
    job.methods = parse_methods(integrators, accuracy);
    if (const auto value = object.find("reference_integrator")) {
        job.reference_method = bench_method(value->choice(integrator_names));
    }
    if (const auto value = object.find("time")) job.seconds = value->number(1e-3, 1e7);
    if (const auto value = object.find("reference_time")) job.reference_seconds = value->number(1e-3, 1e7);
    if (const auto value = object.find("seeds")) job.seeds = static_cast<size_t>(value->integer(2, 1024));
    object.done();
    job.seconds *= scale;
    job.reference_seconds *= scale;
    return job;
}

} // namespace

std::filesystem::path usual_suite()
{
    const std::filesystem::path name = "examples/bench/suite.json";
    if (std::filesystem::exists(name)) return name;
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    for (std::filesystem::path folder = program.parent_path(); folder.has_relative_path();
         folder = folder.parent_path()) {
        if (std::filesystem::exists(folder / name)) return folder / name;
    }
    throw InputError("--suite", "no " + name.string() + " here, nor above the program " + program.string(),
                     "the suite of the source tree", "run it in the source folder, or name the file as --suite=FILE");
}

std::vector<BenchJob> read_suite(const std::filesystem::path& file, double scale)
{
    const JsonDocument document = JsonDocument::load(file);
    JsonObject root = document.root().object();
    std::vector<BenchJob> jobs;
    const JsonValue scenes = root.require("scenes");
    for (const JsonValue& item : scenes.array(1)) {
        jobs.push_back(read_job(item, scale));
        const auto same = [&](const BenchJob& other) { return other.title == jobs.back().title; };
        if (std::ranges::count_if(jobs, same) > 1) item.fail("a name that no other scene has");
    }
    root.done();
    return jobs;
}

} // namespace scree
