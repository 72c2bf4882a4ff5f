#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree pack tile|fill|report`: makes periodic tiles, fills meshes with them, and measures packings.
///
/// Outputs are written completely or not at all. InputError is thrown out of the parse.
void add_pack_command(CLI::App& app);

void add_pack_tile_command(CLI::App& pack);
void add_pack_fill_command(CLI::App& pack);
void add_pack_report_command(CLI::App& pack);

} // namespace scree
