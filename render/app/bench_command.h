#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree bench`.
void add_bench_command(CLI::App& app);

} // namespace scree
