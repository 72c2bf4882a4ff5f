#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree info FILE... [--json] [--frame N] [--radius R|TYPE=R ...]`: describes dumps, points and meshes.
///
/// When parsed, it prints to standard output; it throws InputError out of the parse.
void add_info_command(CLI::App& app);

} // namespace scree
