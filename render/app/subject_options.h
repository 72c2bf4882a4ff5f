#pragma once

#include "render/gsdf/gsdf_subject.h"

namespace CLI {
class App;
class Validator;
} // namespace CLI

namespace scree {

/// Adds the options that set the material and the shape of a command's grains.
void add_subject_options(CLI::App& command, SubjectOptions& options);

/// Like CLI::Range, but also refuses NaN.
CLI::Validator number_in(double least, double most);

} // namespace scree
