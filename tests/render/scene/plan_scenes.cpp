// Runs `scree render SCENE --plan` for many scenes in one process; prints "verdict STATUS MESSAGE" for each.

#include "base/error.h"
#include "render/loop/render_job.h"

#include <fmt/format.h>

int main(int argc, char** argv)
{
    for (int i = 1; i < argc; ++i) {
        scree::RenderJob job;
        job.scene = argv[i];
        job.outputs = {"never.exr"};
        job.plan_only = true;
        job.quiet = true;
        try {
            const int status = scree::run_render_job(job);
            fmt::print("verdict {}\n", status);
        } catch (const scree::InputError& error) {
            fmt::print("verdict 2 {}\n", error.what());
        }
    }
}
