#include "render/stf/stf_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace scree {

namespace {

constexpr double cosine_hemisphere = 2.0 / 3; // its mean cosine

nlohmann::json distance_json(const CosineDistance& distance)
{
    nlohmann::json shares = nlohmann::json::array();
    for (uint32_t bin = 0; bin < CosineDistance::bins; ++bin) shares.push_back(distance.share(bin));
    return {{"l1", distance.distance()}, {"l1_noise", distance.noise()}, {"squared_cosine_shares", shares}};
}

nlohmann::json shell_json(const StfReport& report, size_t i)
{
    const ShellNumbers& shell = report.shells[i];
    return {
        {"radius", shell.radius},
        {"made", report.seconds[i] > 0},
        {"seconds", report.seconds[i]},
        {"walks", report.walks},
        {"records", shell.records},
        {"unscattered", shell.unscattered},
        {"single", shell.single},
        {"multiple", shell.multiple},
        {"at_albedo", {{"single", shell.single_left}, {"multiple", shell.multiple_left}, {"absorbed", shell.absorbed}}},
        {"mean_scatterings", shell.scatterings},
        {"mean_cosine_theta_t", shell.cos_t},
        {"mean_cosine_in_out", shell.straight},
        {"mean_outward_cosine", shell.mean_cosine},
        {"mean_outward_cosine_difference", shell.mean_cosine - cosine_hemisphere},
        {"from_cosine_hemisphere", distance_json(shell.distance)}};
}

nlohmann::json map_json(const ShellMaps& shell, uint32_t row)
{
    const DirectionMap& map = shell.by_theta[row];
    const auto degrees = [](double edge) {
        return 180 / pi * std::acos(std::clamp(1 - 2 * edge / ShellMaps::rows, -1.0, 1.0));
    };
    nlohmann::json density = nlohmann::json::array();
    for (uint32_t cell = 0; cell < DirectionMap::cells; ++cell) density.push_back(map.density(cell));
    return {{"theta_t_degrees", {degrees(row), degrees(row + 1)}},
            {"share", static_cast<double>(map.count()) / static_cast<double>(shell.walks)},
            {"peak", map.peak()},
            {"per_projected_steradian", density}};
}

nlohmann::json figure_json(const StfReport::Figure& figure)
{
    nlohmann::json cells = nlohmann::json::array(), shells = nlohmann::json::array();
    for (uint32_t cell = 0; cell < DirectionMap::cells; ++cell) {
        const V2d centre = DirectionMap::centre(cell);
        cells.push_back({centre.x, centre.y});
    }
    for (const ShellMaps& shell : figure.maps) {
        nlohmann::json maps = nlohmann::json::array();
        for (uint32_t row = 0; row < ShellMaps::rows; ++row) maps.push_back(map_json(shell, row));
        shells.push_back({{"radius", shell.radius},
                          {"walks", shell.walks},
                          {"mean_outward_cosine", shell.mean_cosine},
                          {"from_cosine_hemisphere", distance_json(shell.distance)},
                          {"maps", maps}});
    }
    // A cell is given by the tangential components of its middle direction: along growing theta_t, and across.
    return {{"file", figure.file}, {"cells", cells}, {"shells", shells}};
}

nlohmann::json report_json(const StfReport& report)
{
    nlohmann::json phase{{"kind", report.stf->phase_table ? "table" : "henyey_greenstein"},
                         {"mean_cosine", report.stf->phase.mean_cosine()}};
    if (report.stf->phase_table) phase["density_of_cosine"] = report.stf->phase_table->table().density;
    if (report.grain) phase["gsdf_error"] = report.gsdf_error;
    nlohmann::json shells = nlohmann::json::array();
    for (size_t i = 0; i < report.shells.size(); ++i) shells.push_back(shell_json(report, i));
    nlohmann::json json{
        {"name", report.name}, {"phase_function", phase}, {"albedo", report.albedo}, {"shells", shells}};
    if (!report.remark.empty()) json["remark"] = report.remark;
    if (report.figure) json["figure"] = figure_json(*report.figure);
    return json;
}

} // namespace

ShellNumbers shell_numbers(const StfShell& shell, double albedo)
{
    ShellNumbers numbers;
    numbers.radius = shell.radius;
    numbers.records = shell.exits.size();
    numbers.unscattered = std::exp(-shell.radius);
    const double scattered = 1 - numbers.unscattered;
    double outward = 0;
    numbers.cos_t = numbers.straight = numbers.unscattered;
    for (size_t i = 0; i < shell.exits.size(); ++i) {
        const ShellExit& exit = shell.exits[i];
        const double share = scattered * double{shell.exit_weights[i]}, left = share * std::pow(albedo, exit.events);
        numbers.scatterings += share * exit.events;
        numbers.cos_t += share * double{exit.cos_t};
        numbers.straight += share * place_of(exit).direction.z;
        if (exit.events == 1) {
            numbers.single += share;
            numbers.single_left += left;
            continue;
        }
        numbers.multiple += share;
        numbers.multiple_left += left;
        const double squared = std::max(0.0, 1 - double{exit.away} * exit.away - double{exit.across} * exit.across);
        outward += share * std::sqrt(squared);
        numbers.distance.add(squared, share);
    }
    numbers.absorbed = std::max(0.0, 1 - numbers.unscattered - numbers.single_left - numbers.multiple_left);
    numbers.mean_cosine = numbers.multiple > 0 ? outward / numbers.multiple : 0;
    return numbers;
}

std::string stf_table_head(double albedo)
{
    return fmt::format("{:<17}  {:>7}  {:>11}  {:>8}  {:>8}  {:>13}  {:>8}  {:>8}  {:>11}  {:>9}  {:>7}  {:>7}  {:>7}  "
                       "{:>6}  {:>7}  {:>7}  {:>7}",
                       "grain", "radius", "unscattered", "single", "multiple", fmt::format("{:g}: single", albedo),
                       "multiple", "absorbed", "scatterings", "theta_t", "in.out", "outward", "- 2/3", "L1 %",
                       "noise %", "walks", "seconds");
}

std::string stf_table_line(const StfReport& report, size_t i)
{
    const ShellNumbers& s = report.shells[i];
    return fmt::format("{:<17}  {:>7.6g}  {:>11.4g}  {:>8.5f}  {:>8.5f}  {:>13.5f}  {:>8.5f}  {:>8.5f}  {:>11.5g}  "
                       "{:>9.5f}  {:>7.4f}  {:>7.4f}  {:>7.4f}  {:>6.2f}  {:>7.2f}  {:>7}  {:>7.2f}",
                       report.name, s.radius, s.unscattered, s.single, s.multiple, s.single_left, s.multiple_left,
                       s.absorbed, s.scatterings, s.cos_t, s.straight, s.mean_cosine, s.mean_cosine - cosine_hemisphere,
                       100 * s.distance.distance(), 100 * s.distance.noise(), report.walks, report.seconds[i]);
}

std::string stf_json(const std::vector<StfReport>& reports)
{
    nlohmann::json list = nlohmann::json::array();
    for (const StfReport& report : reports) list.push_back(report_json(report));
    return list.dump(2) + "\n";
}

} // namespace scree
