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

/// One property that a packing should have, and whether it has it, with the numbers.
struct Claim {
    std::string key; ///< a name, the same in every report
    Verdict verdict = Verdict::info;
    std::string text;
};

/// Describes in words where a packing comes from.
struct PackingSource {
    std::string file, mesh;
    std::vector<std::pair<std::string, std::string>> facts; ///< name and value, for the head of the report
    std::vector<std::string> notes;
    /// Whether overlaps must be at most 1e-6, as in tiles and fills; a simulation's spheres may overlap more.
    bool hard = false;
};

/// All measurements of a packing, and the claims that follow.
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

/// Measures everything. The same spheres give the same report on any number of threads. Throws Cancelled.
PackingReport make_packing_report(const PackedSpheres& spheres, PackingSource source, const Progress& progress = {});

/// Judges the measurements; make_packing_report already calls this.
std::vector<Claim> claims_of(const PackingReport& report);

/// All numbers of the report as JSON.
nlohmann::json json_of(const PackingReport& report);

} // namespace scree
