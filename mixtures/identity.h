#pragma once

#include <Imath/ImathQuat.h>

#include <cstdint>

namespace scree {

/// The rotation of the grain with this id: uniform over SO(3) and the same in every frame, run and machine.
///
/// Shoemake 1992, "Uniform random rotations", from three hashes of the id. Unit quaternion.
Imath::Quatd rotation_of_id(uint64_t id);

} // namespace scree
