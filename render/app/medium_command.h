#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree info --medium SCENE... [--json] [--frame N]` to the subcommand `info`: prints the properties of the
/// media of scenes.
///
/// When parsed, it prints to standard output; it throws InputError out of the parse.
void add_medium_option(CLI::App& app);

} // namespace scree
