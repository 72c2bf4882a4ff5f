#include "base/error.h"
#include "render/app/bench_command.h"
#include "render/app/convert_command.h"
#include "render/app/grains_command.h"
#include "render/app/info_command.h"
#include "render/app/medium_command.h"
#include "render/app/mixture_command.h"
#include "render/app/pack_command.h"
#include "render/app/render_command.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

int main(int argc, char** argv)
{
    CLI::App app("Scree: true pictures of granular media", "scree");
    app.set_version_flag("--version", SCREE_VERSION);
    app.require_subcommand(1);
    scree::add_render_command(app);
    scree::add_info_command(app);
    scree::add_medium_option(app);
    scree::add_convert_command(app);
    scree::add_mixture_command(app);
    scree::add_pack_command(app);
    scree::add_grains_command(app);
    scree::add_bench_command(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::RuntimeError& status) {
        return status.get_exit_code();
    } catch (const CLI::Success& success) {
        return app.exit(success);
    } catch (const CLI::Error& error) {
        app.exit(error);
        return 2;
    } catch (const scree::InputError& error) {
        fmt::print(stderr, "scree: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "scree: {}\n", error.what());
        return 1;
    }
    return 0;
}
