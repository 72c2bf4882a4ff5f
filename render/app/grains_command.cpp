#include "render/app/grains_command.h"

#include "render/app/gsdf_command.h"
#include "render/app/stf_command.h"
#include "render/grains/library/grain_library.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace scree {

namespace {

std::string kind_name(const Material& material) { return material.transmits() ? "dielectric" : "lambert"; }

std::string rgb_text(const Color& c, double scale)
{
    if (c.x == c.y && c.y == c.z) return fmt::format("{:.3g}", scale * c.x);
    return fmt::format("{:.3g} {:.3g} {:.3g}", scale * c.x, scale * c.y, scale * c.z);
}

std::string triangles_text(const LibraryGrain& grain)
{
    return grain.default_triangles > 0 ? std::to_string(grain.default_triangles) : "sphere";
}

void print_table()
{
    fmt::print("{:<17}  {:<10}  {:>5}  {:>9}  {:<23}  {:<16}  {:>9}  {:>9}  {}\n", "name", "material", "ior",
               "roughness", "absorption per mm", "reflectance", "radius mm", "triangles", "shape");
    for (const LibraryGrain& grain : grain_library()) {
        const Material& m = grain.material;
        const bool glass = m.transmits();
        fmt::print("{:<17}  {:<10}  {:>5}  {:>9}  {:<23}  {:<16}  {:>9.3g}  {:>9}  {}\n", grain.name, kind_name(m),
                   glass ? fmt::format("{:.3f}", m.ior) : "", glass ? fmt::format("{:.2g}", std::sqrt(m.alpha)) : "",
                   glass ? rgb_text(m.absorption, 1e-3) : "", glass ? "" : rgb_text(m.reflectance, 1),
                   1e3 * grain.typical_radius, triangles_text(grain), grain.description);
    }
}

void print_parameters(const LibraryGrain& grain)
{
    fmt::print("{}: {}\n", grain.name, grain.description);
    if (shape_parameters(grain).empty()) fmt::print("  no parameters\n");
    for (const ShapeParameter& p : shape_parameters(grain))
        fmt::print("  {:<14} {:<8.4g} {:>6.4g} to {:<6.4g} {}\n", p.name, p.value, p.least, p.most, p.what);
}

void print_json(const std::vector<const LibraryGrain*>& grains)
{
    const auto rgb = [](const Color& c) { return nlohmann::json::array({c.x, c.y, c.z}); };
    nlohmann::json list = nlohmann::json::array();
    for (const LibraryGrain* grain : grains) {
        const Material& m = grain->material;
        nlohmann::json material{{"kind", kind_name(m)}};
        if (m.transmits()) {
            material["ior"] = m.ior;
            material["roughness"] = std::sqrt(m.alpha);
            material["absorption_per_metre"] = rgb(m.absorption);
        } else {
            material["reflectance"] = rgb(m.reflectance);
        }
        nlohmann::json parameters = nlohmann::json::object();
        for (const ShapeParameter& p : shape_parameters(*grain)) {
            parameters[p.name] = {{"default", p.value}, {"least", p.least}, {"most", p.most}, {"what", p.what}};
        }
        list.push_back({{"name", grain->name},
                        {"description", grain->description},
                        {"material", material},
                        {"typical_radius", grain->typical_radius},
                        {"triangles", grain->default_triangles},
                        {"version", grain->version},
                        {"parameters", parameters}});
    }
    fmt::print("{}\n", list.dump(2));
}

void add_list_command(CLI::App& grains)
{
    struct Arguments {
        std::vector<std::string> names;
        bool json = false;
    };
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command =
        grains.add_subcommand("list", "List the library's grain types, or the parameters of the named ones");
    command->add_option("name", arguments->names, "Grain types whose parameters to list");
    command->add_flag("--json", arguments->json, "Print everything as JSON");
    command->callback([arguments] {
        std::vector<const LibraryGrain*> chosen;
        for (const std::string& name : arguments->names)
            chosen.push_back(&require_library_grain(name, "scree grains list"));
        if (arguments->json) {
            if (chosen.empty()) {
                for (const LibraryGrain& grain : grain_library()) chosen.push_back(&grain);
            }
            print_json(chosen);
        } else if (chosen.empty()) {
            print_table();
        } else {
            for (const LibraryGrain* grain : chosen) print_parameters(*grain);
        }
    });
}

} // namespace

void add_grains_command(CLI::App& app)
{
    CLI::App* grains =
        app.add_subcommand("grains", "The library of grain types: list them, write their meshes, look at them");
    grains->require_subcommand(1);
    add_list_command(*grains);
    add_grains_export_command(*grains);
    add_grains_show_command(*grains);
    add_gsdf_command(*grains);
    add_stf_command(*grains);
}

} // namespace scree
