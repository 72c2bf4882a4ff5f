#include "render/app/pack_command.h"

#include <CLI/CLI.hpp>

namespace scree {

void add_pack_command(CLI::App& app)
{
    CLI::App* pack =
        app.add_subcommand("pack", "Make periodic tiles of spheres, fill meshes with them, and measure packings");
    pack->require_subcommand(1);
    add_pack_tile_command(*pack);
    add_pack_fill_command(*pack);
    add_pack_report_command(*pack);
}

} // namespace scree
