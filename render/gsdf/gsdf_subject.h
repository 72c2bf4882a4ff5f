#pragma once

#include "render/grains/shape_source.h"

#include <array>
#include <string>
#include <vector>

namespace scree {

/// A grain whose scattering is asked for on the command line.
struct GsdfSubject {
    std::string name; ///< as it was asked for
    ShapeSource shape;
    Material material;
};

/// What overrides the materials and shapes of subjects.
struct SubjectOptions {
    std::optional<std::string> material; ///< kind: lambert, dielectric, conductor
    std::optional<double> ior, roughness;
    std::string eta, k; ///< of a conductor: a number, or three with commas between for RGB; empty: as of Material
    std::optional<uint64_t> triangles, seed; ///< of the library's shapes
};

/// Whether the word is meant to be a mesh file: it ends in .obj, .ply, .stl or .off, or names a folder.
bool is_mesh_file_name(const std::string& word);

/// The grains that the words mean: names of the library (with its materials), "all" of them, "sphere", or mesh files
/// (both dielectrics of index 1.5 unless the options say otherwise).
///
/// place: the command, for messages. Throws InputError for a word that means none, with the nearest that would, and for
/// options that apply to none of them.
std::vector<GsdfSubject> gsdf_subjects(const std::vector<std::string>& words, const SubjectOptions& options,
                                       const std::string& place);

} // namespace scree
