#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree bench --stress [--quick] [--only TEXT] [--stress-json FILE]` to the subcommand `bench`, which may have
/// `--threads` and `--quiet`.
///
/// When it is asked for, it runs as soon as the arguments are read, prints its table to standard output and throws
/// CLI::RuntimeError with the status of the program: 0, 1 when a case fails, 130 when interrupted. So nothing else of
/// `bench` is done.
void add_stress_option(CLI::App& bench);

} // namespace scree
