#include "ingest/info_report.h"

#include "base/text.h"
#include "ingest/frame_statistics.h"
#include "ingest/meshes/triangle_mesh.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace scree {

namespace {

using nlohmann::json;

json to_json(const Imath::V3d& v) { return {v.x, v.y, v.z}; }

json to_json(const std::optional<double>& value) { return value ? json(*value) : json(); }

/// The shortest decimal number that reads back as the same float.
double shortest(double value) { return to_double(fmt::format("{}", static_cast<float>(value))).value_or(value); }

json describe_box(const SimulationBox& box)
{
    const Imath::V3d hi = box.lo + box.edges[0] + box.edges[1] + box.edges[2];
    return {{"lo", to_json(box.lo)},
            {"hi", to_json(hi)},
            {"edges", {to_json(box.edges[0]), to_json(box.edges[1]), to_json(box.edges[2])}},
            {"periodic", box.periodic},
            {"triclinic", box.triclinic},
            {"volume", box.volume()}};
}

/// Adds the frame's contents and statistics to the result; without radii, the values that need radii are null.
void describe_frame(json& result, const ParticleFrame& frame, bool has_radius)
{
    result["step"] = frame.step;
    result["time"] = to_json(frame.time);
    result["units"] = frame.units.empty() ? json() : json(frame.units);
    result["orientations"] = !frame.orientation.empty();
    result["box"] = frame.box ? describe_box(*frame.box) : json();
    const FrameStatistics statistics = measure_frame(frame);
    json types = json::object();
    for (const auto& [type, count] : statistics.count_of_type) types[std::to_string(type)] = count;
    result["types"] = types;
    result["bounds"] =
        statistics.particles > 0 ? json{{"lo", to_json(statistics.lo)}, {"hi", to_json(statistics.hi)}} : json();
    result["duplicates"] = statistics.duplicates;
    for (const char* key : {"radius", "pack_rate", "bed_pack_rate", "max_overlap", "max_overlap_ids",
                            "overlapping_pairs", "overlaps_complete"})
        result[key] = nullptr;
    if (!has_radius) {
        result["notes"].push_back("no column of radii: give them with --radius R, or by type with --radius 1=R 2=R");
        return;
    }
    if (statistics.particles > 0)
        result["radius"] = {{"min", shortest(statistics.radius_min)},
                            {"max", shortest(statistics.radius_max)},
                            {"mean", statistics.radius_mean}};
    result["pack_rate"] = to_json(statistics.pack_rate);
    result["bed_pack_rate"] = to_json(statistics.bed_pack_rate);
    result["max_overlap"] = statistics.max_overlap;
    if (statistics.max_overlap_ids) result["max_overlap_ids"] = *statistics.max_overlap_ids;
    result["overlapping_pairs"] = statistics.overlapping_pairs;
    result["overlaps_complete"] = statistics.overlaps_complete;
    if (!statistics.overlaps_complete)
        result["notes"].push_back(
            "spheres have thousands of neighbours, so not every pair was tested: is the radius right?");
}

std::string words_of(const json& values)
{
    std::vector<std::string> words;
    for (const json& value : values)
        words.push_back(value.is_string() ? value.get<std::string>() : fmt::format("{:.6g}", value.get<double>()));
    return fmt::format("{}", fmt::join(words, " "));
}

/// "16" or "16 to 20": the range of the values of an array, which may be long.
std::string range_of(const json& values)
{
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    if (*least == *greatest) return least->dump();
    return fmt::format("{} to {}", least->dump(), greatest->dump());
}

void append(std::string& text, const char* name, const std::string& value)
{
    text += fmt::format("  {:<13} {}\n", name, value);
}

std::string number(const json& value) { return fmt::format("{:.6g}", value.get<double>()); }

void append_box(std::string& text, const json& box)
{
    if (box.is_null()) return append(text, "box", "none");
    append(text, "box",
           fmt::format("{} to {}{}", words_of(box["lo"]), words_of(box["hi"]),
                       box["triclinic"].get<bool>() ? ", triclinic" : ""));
    if (box["triclinic"].get<bool>())
        append(text, "edges",
               fmt::format("({}) ({}) ({})", words_of(box["edges"][0]), words_of(box["edges"][1]),
                           words_of(box["edges"][2])));
    std::string periodic;
    for (size_t axis = 0; axis < 3; ++axis)
        if (box["periodic"][axis].get<bool>())
            periodic += fmt::format("{}{}", periodic.empty() ? "" : " ",
                                    box["triclinic"].get<bool>() ? "abc"[axis] : "xyz"[axis]);
    append(text, "periodic", periodic.empty() ? "no" : periodic);
}

void append_spheres(std::string& text, const json& d)
{
    if (!d["radius"].is_null())
        append(text, "radius",
               fmt::format("{} to {}, mean {}", number(d["radius"]["min"]), number(d["radius"]["max"]),
                           number(d["radius"]["mean"])));
    append_box(text, d["box"]);
    if (!d["pack_rate"].is_null()) append(text, "pack rate", number(d["pack_rate"]) + " of the box");
    if (!d["bed_pack_rate"].is_null()) append(text, "", number(d["bed_pack_rate"]) + " in the middle of the bed");
    if (!d["max_overlap"].is_null()) {
        if (d["max_overlap_ids"].is_null())
            append(text, "overlaps", "none");
        else
            append(text, "overlaps",
                   fmt::format("{}{} pairs, up to {} of the smaller radius (ids {} and {})",
                               d["overlaps_complete"].get<bool>() ? "" : "more than ", d["overlapping_pairs"].dump(),
                               number(d["max_overlap"]), d["max_overlap_ids"][0].dump(),
                               d["max_overlap_ids"][1].dump()));
    }
    if (d["duplicates"].get<uint64_t>() > 0)
        append(text, "duplicates", d["duplicates"].dump() + " grains at exactly the place of another grain");
}

std::string title_of_format(const std::string& name)
{
    const auto format =
        std::ranges::find_if(particle_formats(), [&](const ParticleFormat& f) { return f.name == name; });
    return format->title;
}

} // namespace

json describe_particles(const std::string& pattern, size_t frame, const ParticleReadOptions& options)
{
    const OpenedParticles opened = open_particles(pattern);
    const ParticleSeries& series = *opened.series;
    ParticleReadOptions reading = options;
    const bool asked = options.radius || !options.radius_of_type.empty();
    const bool has_radius = series.has_radius(frame) || asked;
    if (!has_radius) reading.radius = 0;
    const ParticleFrame particles = series.read(frame, reading);

    json result{{"file", pattern}, {"format", opened.format->name}, {"frames", series.frame_count()}, {"frame", frame}};
    json counts = json::array(), steps = json::array();
    for (size_t i = 0; i < series.frame_count(); ++i) {
        counts.push_back(i == frame ? particles.size() : series.particle_count(i));
        steps.push_back(i == frame ? particles.step : series.step(i));
    }
    result["particles"] = std::move(counts);
    result["steps"] = std::move(steps);
    result["columns"] = series.columns(frame).empty() ? json() : json(series.columns(frame));
    result["notes"] = json::array();
    for (const std::string& warning : series.warnings()) result["notes"].push_back(warning);
    describe_frame(result, particles, has_radius);
    if (!series.type_names().empty()) result["type_names"] = series.type_names();
    if (series.has_radius(frame) && asked) result["notes"].push_back("--radius is not used: the file has radii");
    return result;
}

json describe_mesh(const std::string& path)
{
    const MeshReport report = report_mesh(read_mesh(path));
    std::string format = lower_case(std::filesystem::path(path).extension().string());
    format.erase(0, 1);
    return {{"file", path},
            {"format", format},
            {"vertices", report.vertices},
            {"faces", report.faces},
            {"closed", report.closed},
            {"oriented", report.oriented},
            {"self_intersections", report.self_intersections},
            {"volume", report.volume},
            {"bounds", {{"lo", to_json(report.lo)}, {"hi", to_json(report.hi)}}}};
}

std::string text_of_description(const json& d)
{
    std::string text = d["file"].get<std::string>() + "\n";
    const auto yes_no = [](const json& value) { return value.get<bool>() ? "yes" : "no"; };
    if (d.contains("faces")) {
        append(text, "format", d["format"].get<std::string>() + " mesh");
        append(text, "vertices", d["vertices"].dump());
        append(text, "faces", d["faces"].dump());
        append(text, "closed", yes_no(d["closed"]));
        append(text, "oriented", yes_no(d["oriented"]));
        append(text, "intersections", d["self_intersections"].dump() + " pairs of faces");
        append(text, "volume", number(d["volume"]));
        append(text, "bounds", fmt::format("{} to {}", words_of(d["bounds"]["lo"]), words_of(d["bounds"]["hi"])));
        return text;
    }
    append(text, "format",
           title_of_format(d["format"].get<std::string>()) +
               (d["units"].is_null() ? "" : ", units " + d["units"].get<std::string>()));
    append(text, "frames", fmt::format("{}, steps {}", d["frames"].dump(), range_of(d["steps"])));
    append(text, "particles", range_of(d["particles"]) + (d["frames"] == 1 ? "" : " per frame"));
    if (!d["columns"].is_null()) append(text, "columns", words_of(d["columns"]));
    append(text, "frame",
           fmt::format("{}: step {}{}", d["frame"].dump(), d["step"].dump(),
                       d["time"].is_null() ? "" : ", time " + number(d["time"])));
    std::string types;
    for (const auto& [type, count] : d["types"].items())
        types += fmt::format("{}{} ({})", types.empty() ? "" : ", ", type, count.dump());
    append(text, "types", types.empty() ? "none" : types);
    append_spheres(text, d);
    for (const json& note : d["notes"]) text += "  note: " + note.get<std::string>() + "\n";
    return text;
}

} // namespace scree
