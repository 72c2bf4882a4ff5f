#include "render/bench/suite_run.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "render/bench/bench_page.h"
#include "render/bench/bench_report.h"
#include "render/bench/bench_run.h"

#include <fstream>
#include <iterator>

namespace scree {

namespace {

void make_folder(const std::filesystem::path& folder, const std::vector<std::string>& files)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!std::filesystem::is_directory(folder))
        throw InputError("--output", "'" + folder.string() + "' cannot be created", "a folder that can be written");
    for (const std::string& name : files)
        AtomicFile(folder / name); // throws now, before the work, if it cannot be written
}

std::string text_of(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw InputError(file.string(), "a file that cannot be read", "a text with the two marks of `scree bench`");
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

BenchResult run_and_write(const BenchJob& job, const Progress& progress)
{
    make_folder(job.folder, {"bench.json", "index.html"});
    BenchResult result = run_bench(job, progress);
    write_whole(job.folder / "bench.json", json_of(result));
    write_whole(job.folder / "index.html", page_of(result));
    return result;
}

void run_suite(const std::vector<BenchJob>& jobs, SuiteResult& suite, const std::filesystem::path& folder,
               const std::filesystem::path& readme, const Progress& progress)
{
    make_folder(folder, {"index.html", "README.md", "suite.json"});
    if (!readme.empty()) with_block(text_of(readme), "", readme.string());
    const Stopwatch watch;
    for (BenchJob job : jobs) {
        job.folder = folder / "details" / job.title;
        progress.update(job.title, static_cast<double>(suite.scenes.size()) / static_cast<double>(jobs.size()));
        BenchResult result = run_and_write(job, progress);
        result.reference.picture = {
            result.width(),
            result.height(),
            {},
            {},
            {},
            result.reference.picture.share,
            result.reference.picture.halved}; // drops the pixels; only the size is used from here on
        for (MethodResult& m : result.methods) m.picture = {};
        suite.scenes.push_back(std::move(result));
    }
    suite.seconds = watch.seconds();
    for (const BenchResult& result : suite.scenes)
        write_whole(folder / (result.job.title + ".svg"), svg_of(convergence_plot(result)));
    write_whole(folder / "suite.json", suite_json(suite));
    write_whole(folder / "index.html", suite_page(suite));
    write_whole(folder / "README.md", "# Time against error\n\n" + suite_markdown(suite, true));
    if (!readme.empty())
        write_whole(readme, with_block(text_of(readme), suite_markdown(suite, false), readme.string()));
    progress.update("suite", 1);
}

} // namespace scree
