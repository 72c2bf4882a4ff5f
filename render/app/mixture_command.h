#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree mixture new|show|preview|check`: writes a mixture, tells and draws what it does, holds it against a
/// scene.
///
/// Wherever a mixture file is asked for, a scene will do: its mixture is meant. Outputs appear whole or not at all.
/// Throws InputError out of the parse.
void add_mixture_command(CLI::App& app);

/// Adds `new KIND` to `scree mixture`.
void add_mixture_new_command(CLI::App& mixture);

} // namespace scree
