#pragma once

#include "base/enum_names.h"

#include <cstdint>

namespace scree {

/// What a picture may hold besides its colours.
enum class Aov : uint8_t { albedo, normal, depth, type, id, variance, samples };
inline const EnumNames<Aov> aov_names{{Aov::albedo, "albedo"},  {Aov::normal, "normal"}, {Aov::depth, "depth"},
                                      {Aov::type, "type"},      {Aov::id, "id"},         {Aov::variance, "variance"},
                                      {Aov::samples, "samples"}};

} // namespace scree
