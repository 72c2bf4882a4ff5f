#pragma once

#include "base/enum_names.h"
#include "base/noise.h"
#include "mixtures/checkerboard_mixture.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace scree {

struct MixtureDescription;

/// One grain type for all: {"kind": "single", "type": T}, or just "T".
struct SingleDescription {
    std::string type;
};

/// Each sphere's own type number, out of its dump or out of a table on disk.
struct ExplicitDescription {
    std::map<std::string, std::string> types; ///< number (or word) there -> grain type; empty: as the assembly says
    std::filesystem::path table; ///< .csv (also packed) or .vdb; empty: the dump itself
    std::string column = "type"; ///< of the table, or attribute
    std::string id = "id"; ///< column of ids; spheres go by row in a table that lacks it
};

enum class RandomBy { number, volume };
inline const EnumNames<RandomBy> random_by_names{{RandomBy::number, "number"}, {RandomBy::volume, "volume"}};

struct RandomDescription {
    std::vector<std::string> types;
    std::vector<double> weights; ///< as many as types, not below 0, one above 0
    RandomBy by = RandomBy::number;
    uint64_t seed = 0;
};

struct PerlinDescription {
    std::vector<std::string> types;
    NoiseOptions noise;
    /// Ascending, one fewer than types; or empty, and then `fraction`, as many as types.
    std::vector<double> threshold, fraction;
};

struct CheckerboardDescription {
    std::vector<std::string> types;
    CheckerboardMixture::Board board;
};

struct LayersDescription {
    std::vector<std::string> types;
    std::vector<double> thicknesses; ///< as many as types
    Imath::V3d direction{0, 0, 1};
    double offset = 0;
    bool repeat = true;
    double jitter = 0; ///< amplitude, in units of length; 0: plane faces
    NoiseOptions noise; ///< of the jitter
};

/// types[k] holds spheres of radius below thresholds[k] (ascending, one fewer than types) and not below the one before.
struct RadiusDescription {
    std::vector<std::string> types;
    std::vector<double> thresholds;
};

struct GridDescription {
    struct Field {
        std::string type;
        std::filesystem::path file;
        std::string grid; ///< empty: the file's first float grid
    };
    std::vector<Field> fields;
    std::string rest; ///< type where the concentrations leave room; empty: none
    uint64_t seed = 0;
};

/// `by` (one entry) chooses between mixtures by their names.
struct BlendDescription {
    std::vector<std::string> names; ///< sorted
    std::vector<MixtureDescription> mixtures;
    std::vector<MixtureDescription> by;
};

/// In which frame of a dump a sphere's type is decided, when the mixture depends on more than its id.
struct DecisionFrame {
    bool each = false; ///< anew in every frame
    int64_t frame = -1; ///< else in this one; from the end when negative
    bool operator==(const DecisionFrame&) const = default;
};

/// What a mixture's JSON says: a tree, of names and numbers only.
struct MixtureDescription {
    std::variant<SingleDescription, ExplicitDescription, RandomDescription, PerlinDescription, CheckerboardDescription,
                 LayersDescription, RadiusDescription, GridDescription, BlendDescription>
        kind;
    DecisionFrame decided; ///< read at the root only
    std::string place; ///< "file: /json/path", for messages
};

/// The kinds' names, in the order of the variant.
inline const std::vector<std::string> mixture_kinds{"single", "explicit", "random", "perlin", "checkerboard",
                                                    "layers", "radius",   "grid",   "blend"};

/// The grain types that the mixture names, in order and each once; `chosen_only`: without those of weight or fraction
/// 0. An explicit mixture without a map of its own adds none.
std::vector<std::string> types_named(const MixtureDescription& mixture, bool chosen_only = false);

/// Whether a sphere's type can change from frame to frame: it depends on places, or on which spheres there are.
bool depends_on_frame(const MixtureDescription& mixture);

/// Whether types follow from the spheres of a dump, so that the description alone does not tell them all.
bool needs_dump_types(const MixtureDescription& mixture);

} // namespace scree
