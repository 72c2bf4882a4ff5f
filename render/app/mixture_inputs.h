#pragma once

#include "ingest/particles/particle_series.h"
#include "mixtures/mixture_description.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// A scene's grain types and the source of their spheres; the rest of the scene is ignored.
struct SceneGrains {
    std::vector<std::string> types;
    std::map<int32_t, std::string> file_types; ///< dump's number -> grain type
    std::string dump; ///< pattern; empty: the scene has no dump
    ParticleReadOptions reading;
};

/// Whether the JSON file is a scene with grains, not a mixture.
bool is_scene(const std::filesystem::path& file);

/// Reads the grains of a scene file. Throws InputError when the file is not a scene with grains.
SceneGrains read_scene_grains(const std::filesystem::path& file);

/// One frame of a dump with the type of every sphere.
struct TypedFrame {
    ParticleFrame frame;
    std::vector<uint32_t> types; ///< indices into names
    std::vector<std::string> names;
    std::string title; ///< "file step N"
};

/// Evaluates a mixture on one frame of a dump, as in a film of this dump; see MixtureSeries.
///
/// scene: may be empty; then the types are those that the mixture names, or "type N" for the dump's type number N.
/// frame: counted from the end when negative. Throws InputError.
TypedFrame evaluate_mixture(const MixtureDescription& mixture, const std::optional<SceneGrains>& scene,
                            const std::string& dump, const ParticleReadOptions& reading, int64_t frame);

} // namespace scree
