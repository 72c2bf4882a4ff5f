#include "render/gsdf/gsdf_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace scree {

namespace {

std::string percent(double x) { return fmt::format("{:.3g}", 100 * x); }

std::string form_name(const std::string& form)
{
    if (form == "gsdf") return "ours";
    if (form == "factored") return "factored (the paper's)";
    if (form == "hg") return "Henyey-Greenstein";
    return form;
}

nlohmann::json material_json(const Material& m)
{
    const auto rgb = [](const Color& c) { return nlohmann::json::array({c.x, c.y, c.z}); };
    switch (m.kind) {
    case MaterialKind::lambert: return {{"kind", "lambert"}};
    case MaterialKind::dielectric: return {{"kind", "dielectric"}, {"ior", m.ior}, {"roughness", std::sqrt(m.alpha)}};
    case MaterialKind::conductor: break;
    }
    return {{"kind", "conductor"}, {"eta", rgb(m.eta)}, {"k", rgb(m.k)}, {"roughness", std::sqrt(m.alpha)}};
}

nlohmann::json figure_json(const GsdfReport::Figure& figure)
{
    const auto errors = [](const FormError& e) { return nlohmann::json{{"direction", e.direction}, {"full", e.full}}; };
    nlohmann::json forms = nlohmann::json::object();
    for (const FormError& form : figure.errors.forms) forms[form.form] = errors(form);
    forms["hg"]["g"] = figure.errors.hg_g;
    return {{"file", figure.file},
            {"paths", figure.paths},
            {"mean_error", forms},
            {"noise_floor", errors(figure.errors.noise)}};
}

nlohmann::json report_json(const GsdfReport& report)
{
    const Gsdf& gsdf = *report.found.gsdf;
    const GsdfQuality& quality = gsdf.data().quality;
    nlohmann::json phase{{"theta_degrees", nlohmann::json::array()}, {"per_steradian", phase_function(gsdf)}};
    for (uint32_t row = 0; row < DirectionGrid::rows; ++row)
        phase["theta_degrees"].push_back(180 * (row + 0.5) / DirectionGrid::rows);
    nlohmann::json alpha0{{"q", nlohmann::json::array()}, {"value", gsdf.data().alpha0}};
    for (uint32_t bin = 0; bin < Gsdf::alpha_bins; ++bin) alpha0["q"].push_back((bin + 0.5) / Gsdf::alpha_bins);
    nlohmann::json json{{"name", report.subject.name},
                        {"material", material_json(report.subject.material)},
                        {"traced", report.found.computed},
                        {"seconds", report.seconds},
                        {"tracing_seconds", quality.seconds},
                        {"paths", quality.paths},
                        {"lost_paths", quality.lost},
                        {"error", quality.density_error},
                        {"error_wanted", report.wanted},
                        {"mean_alpha0", gsdf.mean_alpha0()},
                        {"mean_cosine", quality.mean_cosine},
                        {"mean_cosine_error", quality.mean_cosine_error},
                        {"mean_cosine_of_records", gsdf.mean_cosine()},
                        {"records", gsdf.data().records.size()},
                        {"bytes", gsdf.bytes()},
                        {"file", report.found.file.string()},
                        {"alpha0", alpha0},
                        {"phase_function", phase}};
    if (!report.found.remark.empty()) json["remark"] = report.found.remark;
    if (report.figure) json["figure"] = figure_json(*report.figure);
    return json;
}

} // namespace

std::string gsdf_table_head()
{
    return fmt::format("{:<17}  {:<6}  {:>7}  {:>8}  {:>7}  {:>5}  {:>7}  {:>8}  {:>7}  {:>8}  {:>5}  {:>7}  {:>5}  {}",
                       "grain", "from", "seconds", "paths", "error %", "asked", "alpha0", "cosine", "+-", "rec. cos",
                       "lost", "records", "MB", "file");
}

std::string gsdf_table_line(const GsdfReport& report)
{
    const Gsdf& gsdf = *report.found.gsdf;
    const GsdfQuality& quality = gsdf.data().quality;
    return fmt::format("{:<17}  {:<6}  {:>7.2f}  {:>8.3g}  {:>7}  {:>5}  {:>7.4f}  {:>8.5f}  {:>7.5f}  {:>8.5f}  {:>5} "
                       " {:>7}  {:>5.1f}  {}",
                       report.subject.name, report.found.computed ? "traced" : "cache", report.seconds,
                       static_cast<double>(quality.paths), percent(quality.density_error), percent(report.wanted),
                       gsdf.mean_alpha0(), quality.mean_cosine, quality.mean_cosine_error, gsdf.mean_cosine(),
                       quality.lost, gsdf.data().records.size(), 1e-6 * static_cast<double>(gsdf.bytes()),
                       report.found.file.empty() ? "not kept" : report.found.file.string());
}

std::vector<std::string> form_table(const MapErrors& errors, const std::string& grain)
{
    std::vector<std::string> lines;
    lines.push_back(fmt::format("{:<24}  {:>21}  {:>27}", "mean error %, " + grain, "p(omega_i | beta_o)",
                                "p(omega_i, gamma_o | beta_o)"));
    for (const FormError& form : errors.forms)
        lines.push_back(
            fmt::format("{:<24}  {:>21}  {:>27}", form_name(form.form), percent(form.direction), percent(form.full)));
    lines.push_back(fmt::format("{:<24}  {:>21}  {:>27}", "noise floor", percent(errors.noise.direction),
                                percent(errors.noise.full)));
    return lines;
}

std::string gsdf_json(const std::vector<GsdfReport>& reports)
{
    nlohmann::json list = nlohmann::json::array();
    for (const GsdfReport& report : reports) list.push_back(report_json(report));
    return list.dump(2) + "\n";
}

std::vector<double> phase_function(const Gsdf& gsdf)
{
    std::vector<double> phase(DirectionGrid::rows);
    for (uint32_t cell = 0; cell < Gsdf::cells; ++cell) {
        double mass = 0;
        for (uint32_t s = 0; s < Gsdf::strata; ++s) mass += gsdf.stratum_mass(s) * gsdf.cell_mass(s, cell);
        phase[cell / DirectionGrid::columns] += mass / (DirectionGrid::area(cell) * DirectionGrid::columns);
    }
    return phase;
}

} // namespace scree
