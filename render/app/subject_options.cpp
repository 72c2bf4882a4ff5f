#include "render/app/subject_options.h"

#include "base/text.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace scree {

CLI::Validator number_in(double least, double most)
{
    const auto check = [least, most](const std::string& text) {
        const auto number = to_double(text);
        return number && *number >= least && *number <= most
                   ? std::string()
                   : fmt::format("{} is not a number from {:g} to {:g}", in_quotes(text), least, most);
    };
    return {check, fmt::format("{:g} to {:g}", least, most)};
}

void add_subject_options(CLI::App& command, SubjectOptions& options)
{
    command.add_option("--material", options.material,
                       "lambert, dielectric or conductor (default: the library's, or a dielectric of index 1.5)");
    command.add_option("--ior", options.ior, "Refractive index of a dielectric")->check(number_in(0.1, 10));
    command.add_option("--roughness", options.roughness, "Roughness of a dielectric or conductor, 0 (smooth) to 1")
        ->check(number_in(0, 1));
    command.add_option("--eta", options.eta, "Refractive index of a conductor: one number, or red,green,blue");
    command.add_option("--k", options.k, "Imaginary part of that index: one number, or red,green,blue");
    command.add_option("--seed", options.seed, "Seed of the individual shape of library grains")
        ->check(CLI::NonNegativeNumber);
    command
        .add_option("--triangles", options.triangles,
                    "About how many triangles a library shape has (default: the type's)")
        ->check(CLI::Range(least_shape_triangles, most_shape_triangles));
}

} // namespace scree
