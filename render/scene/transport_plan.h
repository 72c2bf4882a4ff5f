#pragma once

#include "render/film/pixel_size.h"
#include "render/scene/scene_description.h"

#include <Imath/ImathBox.h>

#include <string>

namespace scree {

/// What is known of a scene's grains before anything is made of them; lengths in the scene's unit.
struct GrainFacts {
    uint64_t count = 0;
    double mean_radius = 0, largest_radius = 0;
    Imath::Box3d bounds; ///< around all of them
    /// Part of the light that a grain they have absorbs in the mean, about, in the brightest channel; weighed by
    /// cross-section.
    double loss = 0;

    /// How many grains light meets among them in the mean, about, before it is back out or absorbed: 1 / sqrt(1 -
    /// albedo), of an isotropic half-space.
    double encounters() const { return 1 / std::sqrt(std::max(loss, 1e-12)); }
};

/// What a grain of a material absorbs in its brightest channel, about; radius in the unit of the absorption.
double rough_loss(const Material& material, double radius);

/// How light is traced among a scene's grains and media: every switch, as the integrator and its accuracy have set it
/// or the user has.
struct TransportPlan {
    IntegratorKind kind = IntegratorKind::ept;
    Accuracy accuracy = Accuracy::standard;
    bool has_grains = false; ///< the scene has any
    uint32_t explicit_grains = all_grains; ///< grains of a path that are traced as they are; further ones are proxies
    double least_pixels = 0; ///< grains that look smaller in the picture are proxies from the first on
    bool has_grain_medium = false; ///< a medium stands for some grains,
    bool replaces_all = false; ///< or for all
    double depth_radii = 0,
           depth_flights = 0; ///< below every face it begins: mean radii, but not fewer mean flights of the medium
    EquivalentForm medium_form = EquivalentForm::decay;
    bool has_shells = false; ///< light goes through shells in media
    StfForm stf_form = StfForm::full;
    double least_shell = 1; ///< mean free paths: of the largest in a medium, else it gets none
    bool shells_must_pay = false; ///< a medium of grids gets none where walks in it do not show that they save work
    std::string why; ///< why grains are taken in this way
    std::string why_no_medium; ///< empty where a medium stands for grains

    bool has_proxies() const { return has_grains && explicit_grains != all_grains && !replaces_all; }
    /// Whether a path can meet grains as they are.
    bool has_exemplars() const { return has_grains && explicit_grains > 0 && !replaces_all; }
    bool needs_gsdfs() const { return has_proxies() || has_grain_medium; }
    /// In a word for a picture's header: what it does, for auto.
    std::string name() const;
};

/// Hash of all that makes one plan's samples others than another's, as a checkpoint must tell: every switch of what the
/// plan has, none of what it lacks.
uint64_t hash_plan(const TransportPlan& plan);

/// Decides. Facts of no grains: the scene has none.
TransportPlan plan_transport(const IntegratorDescription& integrator, const CameraDescription& camera,
                             const FilmDescription& film, const GrainFacts& facts);

PixelSize pixel_size(const CameraDescription& camera, const FilmDescription& film);

} // namespace scree
