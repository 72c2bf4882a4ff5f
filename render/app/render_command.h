#pragma once

namespace CLI {
class App;
}

namespace scree {

/// `scree render`: adds the subcommand; its work runs when the program's arguments ask for it.
void add_render_command(CLI::App& app);

} // namespace scree
