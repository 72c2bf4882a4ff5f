#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree convert IN OUT [--frame N] [--radius R|TYPE=R ...]`: one frame of a dump as .csv or .vdb points.
///
/// The output appears whole or not at all. Throws InputError out of the parse.
void add_convert_command(CLI::App& app);

} // namespace scree
