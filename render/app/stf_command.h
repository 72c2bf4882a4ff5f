#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree grains stf`: finds the shell transport functions of grains' phase functions, or of Henyey and
/// Greenstein's, in the cache or makes them, reports how shells scatter light, and draws its directions (see
/// stf_figure.h).
///
/// Outputs appear whole or not at all. Throws InputError out of the parse.
void add_stf_command(CLI::App& grains);

} // namespace scree
