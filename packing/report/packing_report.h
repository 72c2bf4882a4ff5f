#pragma once

#include "base/progress.h"
#include "packing/report/bond_order.h"
#include "packing/report/containment.h"
#include "packing/report/laguerre_cells.h"
#include "packing/report/near_pairs.h"
#include "packing/report/packed_spheres.h"
#include "packing/report/pair_correlation.h"
#include "packing/report/radius_statistics.h"
#include "packing/report/solid_fraction.h"
#include "packing/report/void_chords.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace scree {

enum class Verdict { pass, fail, info };

/// "PASS", "FAIL", "INFO".
const char* word_of(Verdict verdict);

/// One thing a packing is held to be, and whether it is, with the numbers.
struct Claim {
    std::string key; ///< a word, the same in every report
    Verdict verdict = Verdict::info;
    std::string text;
};

/// Where a packing comes from, in words.
struct PackingSource {
    std::string file, mesh;
    std::vector<std::pair<std::string, std::string>> facts; ///< name and value, for the head of the report
    std::vector<std::string> notes;
    /// Whether the spheres are held to the overlap of at most 1e-6 of tiles and fills; those of a simulation are not.
    bool hard = false;
};

/// Everything that is measured of a packing, and what follows.
struct PackingReport {
    PackingSource source;
    std::string container; ///< in words
    uint64_t spheres = 0;
    RadiusStatistics radii;
    SolidFraction fraction;
    std::vector<FractionProfile> profiles;
    NearPairs near;
    std::optional<Containment> containment;
    PairCorrelation correlation;
    VoidChords chords;
    LaguerreCells cells;
    BondOrder bonds;
    double theory_contact = 0; ///< Carnahan-Starling, or BMCSL for spheres of several sizes, at the bulk's fraction
    std::vector<Claim> claims;
};

/// Measures it all. The same for the same spheres on any number of threads. Throws Cancelled.
PackingReport make_packing_report(const PackedSpheres& spheres, PackingSource source, const Progress& progress = {});

/// What the measurements say; make_packing_report has done it.
std::vector<Claim> claims_of(const PackingReport& report);

/// All the numbers.
nlohmann::json json_of(const PackingReport& report);

} // namespace scree
