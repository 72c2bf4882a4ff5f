#pragma once

#include "base/math.h"
#include "base/render_space.h"
#include "render/grains/exemplar.h"
#include "render/grains/grain_fill.h"
#include "render/grains/grain_store.h"
#include "render/gsdf/gsdf.h"
#include "render/lights/light.h"
#include "render/materials/material.h"
#include "render/media/clearance_field.h"
#include "render/media/medium_region.h"

#include <Imath/ImathBox.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// A grain type ready for tracing: without an exemplar its shape is the bounding sphere itself.
struct GrainType {
    std::string name;
    Material material; ///< absorption in render coordinates
    std::shared_ptr<const Exemplar> exemplar;
    std::shared_ptr<const Gsdf> gsdf = nullptr; ///< scattering of its proxy, if an integrator needs it
};

/// Triangles of the scene that are not grains, in render coordinates.
struct Surface {
    std::string name;
    std::vector<V3f> positions;
    std::vector<std::array<uint32_t, 3>> triangles;
    Material material;
};

/// Everything that light can interact with, in render coordinates.
///
/// The grains are either a list (a grain is then an index into the list) or a fill (a grain is then an id).
struct World {
    RenderSpace space;
    GrainStore grains;
    std::shared_ptr<const GrainFill> fill;
    std::optional<Imath::Box3d> domain; ///< the domain that the grains were packed into, if known; it bounds them
    std::vector<GrainType> types;
    std::vector<Surface> surfaces;
    std::vector<MediumRegion> regions;
    std::shared_ptr<const ClearanceField>
        clearance; ///< Clearance inside the regions from everything that a path may hit there; null: no bound is known.
    LightSet lights;
    uint64_t replaced_grains = 0; ///< number of grains that were removed because a medium replaces all of them

    bool has_grains() const { return fill || grains.size() > 0; }
    /// The number of grains; of a fill, the expected number.
    uint64_t grain_count() const { return fill ? static_cast<uint64_t>(fill->fill().expected_count()) : grains.size(); }
    GrainSphere sphere(uint64_t grain) const
    {
        return fill ? fill->sphere(grain) : GrainSphere{grains.centre(grain), grains.radius(grain)};
    }
    uint64_t id(uint64_t grain) const { return fill ? grain : grains.id(grain); }
    uint8_t type(uint64_t grain) const { return fill ? fill->type(grain) : grains.type_codes[grain]; }
    /// Rotation of a grain from its own frame to the world's.
    Imath::M33d rotation(uint64_t grain) const;
    const FloatMargin& margin() const { return fill ? fill->margin() : grains.margin; }
};

} // namespace scree
