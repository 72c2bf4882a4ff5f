#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree info --medium SCENE... [--json] [--frame N]` to the subcommand `info`: what the media of scenes are, in
/// numbers.
///
/// When parsed, it prints to standard output; it throws InputError out of the parse.
void add_medium_option(CLI::App& app);

} // namespace scree
