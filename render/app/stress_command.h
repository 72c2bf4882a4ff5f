#pragma once

namespace CLI {
class App;
}

namespace scree {

/// Adds `scree bench --stress [--quick] [--only TEXT] [--stress-json FILE]` to the subcommand `bench`, whose
/// `--threads` and `--quiet` it uses if there are any.
///
/// With `--stress` the test runs as soon as the arguments are read, prints its table to standard output and throws
/// CLI::RuntimeError with the status of the program: 0, 1 when a case fails, 130 when interrupted. Nothing else of
/// `bench` runs then.
void add_stress_option(CLI::App& bench);

} // namespace scree
