#include "mixtures/read_mixture.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace scree {

namespace {

using nlohmann::ordered_json;

ordered_json vector_json(const Imath::V3d& v) { return {v.x, v.y, v.z}; }

/// One number if the values of all axes are equal.
ordered_json lengths_json(const Imath::V3d& v) { return v.x == v.y && v.y == v.z ? ordered_json(v.x) : vector_json(v); }

std::string path_text(const std::filesystem::path& path, const std::filesystem::path& folder)
{
    const std::filesystem::path relative = std::filesystem::absolute(path).lexically_normal().lexically_proximate(
        std::filesystem::absolute(folder.empty() ? "." : folder).lexically_normal());
    return relative.generic_string();
}

void add_noise(ordered_json& json, const NoiseOptions& noise)
{
    const NoiseOptions usual;
    json["scale"] = lengths_json(noise.scale);
    if (noise.offset != usual.offset) json["offset"] = vector_json(noise.offset);
    if (noise.octaves != usual.octaves) json["octaves"] = noise.octaves;
    if (noise.lacunarity != usual.lacunarity) json["lacunarity"] = noise.lacunarity;
    if (noise.gain != usual.gain) json["gain"] = noise.gain;
    if (noise.seed != usual.seed) json["seed"] = noise.seed;
}

struct Writer {
    ordered_json& json;
    const std::filesystem::path& folder;

    void operator()(const SingleDescription& mixture) const { json["type"] = mixture.type; }

    void operator()(const ExplicitDescription& mixture) const
    {
        const ExplicitDescription usual;
        if (!mixture.types.empty()) json["types"] = mixture.types;
        if (mixture.table.empty()) return;
        json["table"] = path_text(mixture.table, folder);
        if (mixture.column != usual.column) json["column"] = mixture.column;
        if (mixture.id != usual.id) json["id"] = mixture.id;
    }

    void operator()(const RandomDescription& mixture) const
    {
        json["types"] = mixture.types;
        json["weights"] = mixture.weights;
        if (mixture.by == RandomBy::volume) json["by"] = "volume";
        if (mixture.seed != 0) json["seed"] = mixture.seed;
    }

    void operator()(const PerlinDescription& mixture) const
    {
        json["types"] = mixture.types;
        add_noise(json, mixture.noise);
        json[mixture.fraction.empty() ? "threshold" : "fraction"] =
            mixture.fraction.empty() ? mixture.threshold : mixture.fraction;
    }

    void operator()(const CheckerboardDescription& mixture) const
    {
        json["types"] = mixture.types;
        json["cell"] = lengths_json(mixture.board.cell);
        if (mixture.board.offset != Imath::V3d(0)) json["offset"] = vector_json(mixture.board.offset);
        if (mixture.board.rotation != Imath::V3d(0)) json["rotation"] = vector_json(mixture.board.rotation);
    }

    void operator()(const LayersDescription& mixture) const
    {
        json["types"] = mixture.types;
        json["thicknesses"] = mixture.thicknesses;
        json["direction"] = vector_json(mixture.direction);
        if (mixture.offset != 0) json["offset"] = mixture.offset;
        if (!mixture.repeat) json["repeat"] = false;
        if (mixture.jitter == 0) return;
        ordered_json& jitter = json["jitter"];
        jitter["amplitude"] = mixture.jitter;
        add_noise(jitter, mixture.noise);
    }

    void operator()(const RadiusDescription& mixture) const
    {
        json["types"] = mixture.types;
        json["thresholds"] = mixture.thresholds;
    }

    void operator()(const GridDescription& mixture) const
    {
        for (const auto& field : mixture.fields) {
            ordered_json entry;
            entry["type"] = field.type;
            entry["file"] = path_text(field.file, folder);
            if (!field.grid.empty()) entry["grid"] = field.grid;
            json["fields"].push_back(std::move(entry));
        }
        if (!mixture.rest.empty()) json["rest"] = mixture.rest;
        if (mixture.seed != 0) json["seed"] = mixture.seed;
    }

    void operator()(const BlendDescription& mixture) const
    {
        json["by"] = write_mixture(mixture.by[0], folder);
        for (size_t k = 0; k < mixture.names.size(); ++k)
            json["mixtures"][mixture.names[k]] = write_mixture(mixture.mixtures[k], folder);
    }
};

} // namespace

ordered_json write_mixture(const MixtureDescription& mixture, const std::filesystem::path& folder)
{
    ordered_json json;
    json["kind"] = std::visit([](const auto& kind) { return kind.name; }, mixture.kind);
    std::visit(Writer{json, folder}, mixture.kind);
    if (mixture.decided.each)
        json["frame"] = "each";
    else if (mixture.decided.frame != DecisionFrame().frame)
        json["frame"] = mixture.decided.frame;
    return json;
}

} // namespace scree
