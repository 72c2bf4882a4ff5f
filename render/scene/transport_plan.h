#pragma once

#include "render/film/pixel_size.h"
#include "render/scene/scene_description.h"

#include <Imath/ImathBox.h>

#include <string>

namespace scree {

/// What is known about a scene's grains before anything is built; lengths in the scene's unit.
struct GrainFacts {
    uint64_t count = 0;
    double mean_radius = 0, largest_radius = 0;
    Imath::Box3d bounds; ///< of all grains
    /// About the mean fraction of light that a grain absorbs, in the brightest channel, weighted by cross-section.
    double loss = 0;

    /// About the mean number of grains that light hits before it leaves or is absorbed: 1 / sqrt(1 - albedo), as in an
    /// isotropic half-space.
    double encounters() const { return 1 / std::sqrt(std::max(loss, 1e-12)); }
};

/// About the fraction of light that a grain absorbs in its brightest channel; radius in the unit of the absorption.
double rough_loss(const Material& material, double radius);

/// How light is traced through a scene's grains and media: every switch, as set by the integrator, its accuracy or the
/// user.
struct TransportPlan {
    IntegratorKind kind = IntegratorKind::ept;
    Accuracy accuracy = Accuracy::standard;
    bool has_grains = false; ///< the scene has at least one grain
    uint32_t explicit_grains = all_grains; ///< grains of a path traced as explicit geometry; further ones are proxies
    double least_pixels = 0; ///< if a path's first grain looks narrower in the picture, all are proxies
    bool has_grain_medium = false; ///< a medium replaces some grains,
    bool replaces_all = false; ///< or all grains
    double depth_radii = 0; ///< depth below every face at which the medium begins: mean radii,
    double depth_flights = 0; ///< but no fewer mean free paths of the medium
    EquivalentForm medium_form = EquivalentForm::decay;
    bool has_shells = false; ///< light crosses media in shells
    StfForm stf_form = StfForm::full;
    double least_shell = 1; ///< mean free paths: a medium whose largest shell is smaller gets no shells
    bool shells_must_pay = false; ///< a medium of grids gets shells only if trial walks show that shells save work
    std::string why; ///< why grains are traced in this way
    std::string why_no_medium; ///< empty if a medium replaces grains

    bool has_proxies() const { return has_grains && explicit_grains != all_grains && !replaces_all; }
    /// Whether a path can hit grains that are explicit geometry.
    bool has_exemplars() const { return has_grains && explicit_grains > 0 && !replaces_all; }
    bool needs_gsdfs() const { return has_proxies() || has_grain_medium; }
    /// The integrator's name for a picture's header; "ept" if auto only does what ept does.
    std::string name() const;
};

/// Hash of everything in a plan that changes its samples, for checkpoints: the switches of what the plan has, not of
/// what it lacks.
uint64_t hash_plan(const TransportPlan& plan);

/// Chooses the transport plan. Facts with a count of 0: the scene has no grains.
TransportPlan plan_transport(const IntegratorDescription& integrator, const CameraDescription& camera,
                             const FilmDescription& film, const GrainFacts& facts);

/// Width of one pixel of the film, in the scene's unit.
PixelSize pixel_size(const CameraDescription& camera, const FilmDescription& film);

} // namespace scree
