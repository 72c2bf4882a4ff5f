#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree grains list|export|show|gsdf|stf`: the library of grain types, their meshes, pictures and scattering.
///
/// Outputs appear whole or not at all. Throws InputError out of the parse.
void add_grains_command(CLI::App& app);

void add_grains_export_command(CLI::App& grains);
void add_grains_show_command(CLI::App& grains);

} // namespace scree
