#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree grains gsdf`: finds the scattering of grains in the cache or traces it, reports how accurate it is, and
/// draws the error maps of one grain (see error_figure.h).
///
/// Outputs appear whole or not at all. Throws InputError out of the parse.
void add_gsdf_command(CLI::App& grains);

} // namespace scree
