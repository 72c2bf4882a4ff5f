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

/// One grain type for all spheres: {"kind": "single", "type": T}, or just "T".
struct SingleDescription {
    static constexpr const char* name = "single";
    std::string type;
};

/// Each sphere's own type number, from its dump or from a table on disk.
struct ExplicitDescription {
    static constexpr const char* name = "explicit";
    std::map<std::string, std::string> types; ///< number (or word) there -> grain type; empty: the assembly's map
    std::filesystem::path table; ///< .csv (also packed) or .vdb; empty: the dump itself
    std::string column = "type"; ///< the table's column (or attribute) of types
    std::string id = "id"; ///< the table's column of ids; without it row i is sphere i
};

enum class RandomBy { number, volume };
inline const EnumNames<RandomBy> random_by_names{{RandomBy::number, "number"}, {RandomBy::volume, "volume"}};

struct RandomDescription {
    static constexpr const char* name = "random";
    std::vector<std::string> types;
    std::vector<double> weights; ///< as many as types, not below 0, one above 0
    RandomBy by = RandomBy::number;
    uint64_t seed = 0;
};

struct PerlinDescription {
    static constexpr const char* name = "perlin";
    std::vector<std::string> types;
    NoiseOptions noise;
    /// threshold: ascending, one fewer than types; if empty, `fraction` is used and has as many entries as types.
    std::vector<double> threshold, fraction;
};

struct CheckerboardDescription {
    static constexpr const char* name = "checkerboard";
    std::vector<std::string> types;
    CheckerboardMixture::Board board;
};

struct LayersDescription {
    static constexpr const char* name = "layers";
    std::vector<std::string> types;
    std::vector<double> thicknesses; ///< as many as types
    Imath::V3d direction{0, 0, 1};
    double offset = 0;
    bool repeat = true;
    double jitter = 0; ///< amplitude, in units of length; 0: plane faces
    NoiseOptions noise; ///< noise of the jitter
};

/// types[k] is for radii below thresholds[k] (ascending, one fewer than types) and not below thresholds[k - 1].
struct RadiusDescription {
    static constexpr const char* name = "radius";
    std::vector<std::string> types;
    std::vector<double> thresholds;
};

struct GridDescription {
    static constexpr const char* name = "grid";
    struct Field {
        std::string type;
        std::filesystem::path file;
        std::string grid; ///< empty: the file's first float grid
    };
    std::vector<Field> fields;
    std::string rest; ///< type for the probability that the concentrations leave; empty: none
    uint64_t seed = 0;
};

/// `by` (one entry) chooses one of the mixtures by its name.
struct BlendDescription {
    static constexpr const char* name = "blend";
    std::vector<std::string> names; ///< sorted
    std::vector<MixtureDescription> mixtures;
    std::vector<MixtureDescription> by;
};

/// The frame of a dump that decides a sphere's type, if the mixture depends on more than the sphere's id.
struct DecisionFrame {
    bool each = false; ///< every frame decides anew
    int64_t frame = -1; ///< otherwise this frame decides; counted from the end when negative
    bool operator==(const DecisionFrame&) const = default;
};

/// The contents of a mixture's JSON: a tree of names and numbers only.
struct MixtureDescription {
    std::variant<SingleDescription, ExplicitDescription, RandomDescription, PerlinDescription, CheckerboardDescription,
                 LayersDescription, RadiusDescription, GridDescription, BlendDescription>
        kind;
    DecisionFrame decided; ///< read at the root only
    std::string place; ///< "file: /json/path", for messages
};

/// The names of all kinds, as a mixture's JSON has them.
inline const std::vector<std::string> mixture_kinds = [] {
    return []<class... Kinds>(const std::variant<Kinds...>*) {
        return std::vector<std::string>{Kinds::name...};
    }(static_cast<const decltype(MixtureDescription::kind)*>(nullptr));
}();

/// The grain types that the mixture names, in order, each once; `chosen_only`: without types that are never chosen
/// (weight or fraction 0). An explicit mixture without its own map adds none.
std::vector<std::string> types_named(const MixtureDescription& mixture, bool chosen_only = false);

/// Whether a sphere's type can change from frame to frame, because it depends on positions or on the set of spheres.
bool depends_on_frame(const MixtureDescription& mixture);

/// Whether some types come from the map of an assembly, so that the description alone does not name them all.
bool needs_dump_types(const MixtureDescription& mixture);

} // namespace scree
