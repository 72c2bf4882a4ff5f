#pragma once

#include "render/grains/shape_source.h"

#include <array>
#include <string>
#include <vector>

namespace scree {

/// A grain whose scattering is asked for on the command line.
struct GsdfSubject {
    std::string name; ///< the word that asked for it
    ShapeSource shape;
    Material material;
};

/// Options that override the materials and shapes of subjects.
struct SubjectOptions {
    std::optional<std::string> material; ///< kind: lambert, dielectric, conductor
    std::optional<double> ior, roughness;
    std::string eta, k; ///< of a conductor: one number, or three for RGB with commas between; empty: unchanged
    std::optional<uint64_t> triangles, seed; ///< of the library's shapes
};

/// Whether the word is taken for a mesh file: it ends in .obj, .ply, .stl or .off, or contains a slash.
bool is_mesh_file_name(const std::string& word);

/// The grains that the words name: library grains (with their materials), "all" of these, "sphere", or mesh files (the
/// last two are dielectrics of index 1.5 unless the options say otherwise).
///
/// place: the command, for messages. Throws InputError for a word that names no grain, with the nearest name as a hint,
/// and for options that do not apply.
std::vector<GsdfSubject> gsdf_subjects(const std::vector<std::string>& words, const SubjectOptions& options,
                                       const std::string& place);

} // namespace scree
