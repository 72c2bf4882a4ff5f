#pragma once

#include <vector>

namespace scree {

/// Mean powers of the radii of spheres, averaged by number: m1 = <r>, ..., m6 = <r^6>; m[0] = 1.
struct RadiusMoments {
    double m[7] = {1, 0, 0, 0, 0, 0, 0};

    double mean_volume() const;
    /// sqrt(<r^2> - <r>^2) / <r>.
    double polydispersity() const;
};

/// Mean chord of the voids between non-overlapping spheres at volume fraction f: 4 (1 - f) <r^3> / (3 f <r^2>).
/// Exact for isotropic uniform random lines and any arrangement of the spheres (Cauchy; Underwood 1970).
double mean_void_chord(double fraction, const RadiusMoments& radii);

/// The contact value g(1+) of the fluid of equal hard spheres: (1 - f/2) / (1 - f)^3 (Carnahan, Starling, J. Chem.
/// Phys. 51, 1969).
double carnahan_starling_contact(double fraction);

/// The contact value of mixtures (Boublik 1970; Mansoori, Carnahan, Starling, Leland 1971), averaged over pairs of
/// spheres with the weight (r_i + r_j)^3, the weight in g as a function of d / (r_i + r_j). Equals Carnahan-Starling
/// for equal spheres.
double bmcsl_contact(double fraction, const RadiusMoments& radii);

/// g(x) of equal hard spheres after Percus and Yevick, x in diameters, at x = 1, 1 + step, ... up to x_max or just
/// beyond.
///
/// Baxter's factorisation (Aust. J. Phys. 21, 1968, 563), solved outwards after Perram (Mol. Phys. 30, 1975, 1505).
/// 0 < fraction < 1; step = 1 / steps_per_diameter diameters.
std::vector<double> percus_yevick(double fraction, int steps_per_diameter, double x_max);

} // namespace scree
