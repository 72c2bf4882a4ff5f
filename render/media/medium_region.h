#pragma once

#include "render/media/medium.h"

#include <Imath/ImathBox.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace scree {

class MediumShells;

/// A closed surface with a medium inside, in render coordinates.
struct MediumRegion {
    std::string name;
    std::vector<V3f> positions;
    std::vector<std::array<uint32_t, 3>> triangles; ///< closed, counter-clockwise from outside
    std::shared_ptr<const Medium> medium;
    std::shared_ptr<const MediumShells> shells; ///< for steps of many mean free paths, or null
    bool instead_of_grains = false; ///< the medium replaces the grains in there

    Imath::Box3d bounds() const
    {
        Imath::Box3d box;
        for (const V3f& p : positions) box.extendBy(V3d(p));
        return box;
    }
    bool is_achromatic() const { return medium->is_achromatic(); }
};

} // namespace scree
