#pragma once

namespace scree {

/// Keeps CGAL from writing to standard error; its failures still arrive as exceptions. Cheap to call again.
void silence_cgal();

} // namespace scree
