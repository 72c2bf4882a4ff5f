#pragma once

#include "packing/report/packing_report.h"

#include <string>

namespace scree {

/// The report as one HTML page with its plots inside: needs no network and no script. Well-formed XML, the same for the
/// same report.
std::string html_of(const PackingReport& report);

} // namespace scree
