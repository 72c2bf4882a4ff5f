#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree convert IN OUT [--frame N] [--radius R|TYPE=R ...]`: one frame of a dump as .csv or .vdb points.
///
/// The output is written completely or not at all. The command runs inside CLI11's parse, which then throws InputError.
void add_convert_command(CLI::App& app);

} // namespace scree
