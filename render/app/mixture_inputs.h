#pragma once

#include "ingest/particles/particle_series.h"
#include "mixtures/mixture_description.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// What a scene says about its grain types and their spheres; the rest of it is not looked at.
struct SceneGrains {
    std::vector<std::string> types;
    std::map<int32_t, std::string> file_types; ///< dump's number -> grain type
    std::string dump; ///< pattern; empty: the scene has no dump
    ParticleReadOptions reading;
};

/// Whether the JSON file is a scene with grains, and not a mixture.
bool is_scene(const std::filesystem::path& file);

/// Throws InputError when the file is no scene with grains.
SceneGrains read_scene_grains(const std::filesystem::path& file);

/// One frame of a dump with the type of every sphere.
struct TypedFrame {
    ParticleFrame frame;
    std::vector<uint32_t> types; ///< places in names
    std::vector<std::string> names;
    std::string title; ///< "file step N"
};

/// Evaluates a mixture on a frame of a dump as a film of it would: see MixtureSeries.
///
/// scene: nothing, and then the types are those that the mixture names, or "type N" of the dump. frame: from the end
/// when negative. Throws InputError.
TypedFrame evaluate_mixture(const MixtureDescription& mixture, const std::optional<SceneGrains>& scene,
                            const std::string& dump, const ParticleReadOptions& reading, int64_t frame);

} // namespace scree
