#pragma once

#include "packing/report/packing_report.h"

#include <string>

namespace scree {

/// The report as one HTML page that contains its plots and needs no network and no script. Well-formed XML; equal
/// reports give equal pages.
std::string html_of(const PackingReport& report);

} // namespace scree
