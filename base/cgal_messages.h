#pragma once

namespace scree {

/// Keeps CGAL from writing to standard error; CGAL's failures still arrive as exceptions. Repeated calls are cheap.
void silence_cgal();

} // namespace scree
