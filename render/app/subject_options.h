#pragma once

#include "render/gsdf/gsdf_subject.h"

namespace CLI {
class App;
class Validator;
} // namespace CLI

namespace scree {

/// Adds the options that decide of what material and shape the grains of a command are.
void add_subject_options(CLI::App& command, SubjectOptions& options);

/// As CLI::Range, which lets NaN pass.
CLI::Validator number_in(double least, double most);

} // namespace scree
