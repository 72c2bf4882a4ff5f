#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree mixture new|show|preview|check`: writes a mixture, describes it, draws it, checks it against a scene.
///
/// A scene file can replace a mixture file; its mixture is then used. Outputs appear whole or not at all.
/// Parsing a command line with bad input throws InputError.
void add_mixture_command(CLI::App& app);

/// Adds `new KIND` to `scree mixture`.
void add_mixture_new_command(CLI::App& mixture);

} // namespace scree
