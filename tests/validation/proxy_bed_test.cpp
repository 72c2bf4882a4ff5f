// Packed beds: the mean radiance with proxies agrees with explicit geometry within 1 % (in blue, where the tea-coloured
// glass absorbs most).

#include "tests/builders/grain_beds.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

void compare(const BedGrain& grain, double fraction, const std::string& name)
{
    const auto bed = make_bed(grain, fraction, 1500);
    const Estimate as_is = bed_radiance(*bed, 60000, all_grains, 1), proxies = bed_radiance(*bed, 60000, 0, 2),
                   first = bed_radiance(*bed, 60000, 1, 3);
    for (const auto& [estimate, what] : {std::pair{proxies, "proxies"}, std::pair{first, "one as it is"}}) {
        const double error = std::hypot(as_is.standard_error(), estimate.standard_error());
        // 60,000 paths leave a standard error of 0.4 to 0.8 % of the mean.
        EXPECT_LT(std::abs(estimate.mean() - as_is.mean()), 0.01 * as_is.mean() + 3 * error) << name << " " << what;
        std::printf("%-22s f %.1f: as they are %.5f, %s %+.2f %% +- %.2f\n", name.c_str(), fraction, as_is.mean(), what,
                    100 * (estimate.mean() / as_is.mean() - 1), 100 * error / as_is.mean());
    }
}

TEST(ProxyBeds, MeanRadianceIsThatOfGrainsAsTheyAre)
{
    for (const BedGrain& grain : bed_grains(0.05)) {
        for (const double fraction : {0.2, 0.4, 0.6}) compare(grain, fraction, grain.name);
        if (grain.name != "tea glass spheres") continue;
        for (const float times : {0.25f, 4.0f}) { // like grains a quarter and four times as large
            BedGrain other = grain;
            other.material.absorption *= times;
            compare(other, 0.4, grain.name + (times < 1 ? ", small" : ", large"));
        }
    }
}

} // namespace
} // namespace scree
