#include "mixtures/describe_mixture.h"

#include <fmt/format.h>

#include <numeric>

namespace scree {

namespace {

using Fractions = std::optional<std::map<std::string, double>>;

Fractions shares(const std::vector<std::string>& types, const std::vector<double>& weights)
{
    const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::map<std::string, double> result;
    for (size_t k = 0; k < types.size(); ++k) result[types[k]] += weights[k] / all;
    return result;
}

/// The fractions between ascending thresholds.
std::vector<double> fractions_between(const PerlinDescription& mixture)
{
    std::vector<double> fractions;
    double before = 0;
    for (const double below : FractalNoise(mixture.noise).fractions_below(mixture.threshold)) {
        fractions.push_back(below - before);
        before = below;
    }
    fractions.push_back(1 - before);
    return fractions;
}

struct Expectation {
    Fractions operator()(const SingleDescription& mixture) const { return shares({mixture.type}, {1}); }
    Fractions operator()(const ExplicitDescription&) const { return std::nullopt; }
    Fractions operator()(const RandomDescription& mixture) const { return shares(mixture.types, mixture.weights); }
    Fractions operator()(const PerlinDescription& mixture) const
    {
        return shares(mixture.types, mixture.fraction.empty() ? fractions_between(mixture) : mixture.fraction);
    }
    Fractions operator()(const CheckerboardDescription& mixture) const
    {
        return shares(mixture.types, std::vector<double>(mixture.types.size(), 1));
    }
    Fractions operator()(const LayersDescription& mixture) const
    {
        return mixture.repeat ? shares(mixture.types, mixture.thicknesses) : std::nullopt;
    }
    Fractions operator()(const RadiusDescription&) const { return std::nullopt; }
    Fractions operator()(const GridDescription&) const { return std::nullopt; }
    Fractions operator()(const BlendDescription& mixture) const
    {
        const Fractions chosen = expected_fractions(mixture.by[0]);
        if (!chosen) return std::nullopt;
        std::map<std::string, double> result;
        for (size_t k = 0; k < mixture.names.size(); ++k) {
            const auto weight = chosen->find(mixture.names[k]);
            if (weight == chosen->end() || weight->second == 0) continue;
            const Fractions inner = expected_fractions(mixture.mixtures[k]);
            if (!inner) return std::nullopt;
            for (const auto& [type, fraction] : *inner) result[type] += weight->second * fraction;
        }
        return result;
    }
};

std::string vector_words(const Imath::V3d& v)
{
    return v.x == v.y && v.y == v.z ? fmt::format("{}", v.x) : fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

std::string percent(double part, double all) { return fmt::format("{:.4g} %", 100 * part / all); }

std::string list_of(const std::vector<std::string>& types, const std::vector<double>& weights)
{
    const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<std::string> words;
    for (size_t k = 0; k < types.size(); ++k) words.push_back(percent(weights[k], all) + " " + types[k]);
    return fmt::format("{}", fmt::join(words, ", "));
}

/// "a below 1, b up to 2, c from there on".
std::string intervals(const std::vector<std::string>& types, const std::vector<double>& thresholds)
{
    std::vector<std::string> words;
    for (size_t k = 0; k < types.size(); ++k) {
        if (k < thresholds.size())
            words.push_back(fmt::format("{} {} {}", types[k], k == 0 ? "below" : "up to", thresholds[k]));
        else
            words.push_back(types[k] + (k > 0 ? " from there on" : " everywhere"));
    }
    return fmt::format("{}", fmt::join(words, ", "));
}

std::string noise_words(const NoiseOptions& noise)
{
    std::string words = fmt::format("{} wide", vector_words(noise.scale));
    if (noise.octaves > 1)
        words += fmt::format(", {} octaves (lacunarity {}, gain {})", noise.octaves, noise.lacunarity, noise.gain);
    if (noise.offset != Imath::V3d(0)) words += fmt::format(", offset {}", vector_words(noise.offset));
    if (noise.seed != 0) words += fmt::format(", seed {}", noise.seed);
    return words;
}

struct Words {
    std::string indent;

    std::string operator()(const SingleDescription& mixture) const { return mixture.type + " only"; }

    std::string operator()(const ExplicitDescription& mixture) const
    {
        std::string words = "each sphere's own type, as the dump gives it";
        if (!mixture.table.empty())
            words = fmt::format("each sphere's own type, by column '{}' of {}", mixture.column, mixture.table.string());
        for (const auto& [number, type] : mixture.types) words += fmt::format("\n{}  {} is {}", indent, number, type);
        return words;
    }

    std::string operator()(const RandomDescription& mixture) const
    {
        const char* by = mixture.by == RandomBy::volume ? "volume" : "number";
        return fmt::format("at random, sphere by sphere, by {}: {} (seed {})", by,
                           list_of(mixture.types, mixture.weights), mixture.seed);
    }

    std::string operator()(const PerlinDescription& mixture) const
    {
        const bool fixed = mixture.fraction.empty();
        return fmt::format("in patches of noise {}: {}", noise_words(mixture.noise),
                           fixed ? intervals(mixture.types, mixture.threshold)
                                 : list_of(mixture.types, mixture.fraction));
    }

    std::string operator()(const CheckerboardDescription& mixture) const
    {
        const std::string cell = vector_words(mixture.board.cell);
        std::string words = fmt::format("a checkerboard of cells of {}: {}", cell, fmt::join(mixture.types, ", "));
        if (mixture.board.offset != Imath::V3d(0))
            words += fmt::format("; a corner at {}", vector_words(mixture.board.offset));
        if (mixture.board.rotation != Imath::V3d(0))
            words += fmt::format("; turned by {} degrees", vector_words(mixture.board.rotation));
        return words;
    }

    std::string operator()(const LayersDescription& mixture) const
    {
        std::vector<std::string> layers;
        for (size_t k = 0; k < mixture.types.size(); ++k)
            layers.push_back(fmt::format("{} {}", mixture.thicknesses[k], mixture.types[k]));
        const Imath::V3d& d = mixture.direction;
        std::string words = fmt::format("layers along ({}, {}, {}) from {}: {}, ", d.x, d.y, d.z, mixture.offset,
                                        fmt::join(layers, ", "));
        words += mixture.repeat ? "repeated" : "the first and the last without end";
        if (mixture.jitter != 0)
            words += fmt::format("; faces moved by up to {} by noise {}", mixture.jitter, noise_words(mixture.noise));
        return words;
    }

    std::string operator()(const RadiusDescription& mixture) const
    {
        return "by radius: " + intervals(mixture.types, mixture.thresholds);
    }

    std::string operator()(const GridDescription& mixture) const
    {
        std::string words = fmt::format("at random by concentrations in space (seed {})", mixture.seed);
        for (const auto& field : mixture.fields)
            words += fmt::format("\n{}  {}: {}{}{}", indent, field.type, field.file.string(),
                                 field.grid.empty() ? "" : ":", field.grid);
        if (!mixture.rest.empty()) words += fmt::format("\n{}  {}: the rest", indent, mixture.rest);
        return words;
    }

    std::string operator()(const BlendDescription& mixture) const
    {
        const Words inner{indent + "  "};
        std::string words = fmt::format("a blend, {}", std::visit(inner, mixture.by[0].kind));
        for (size_t k = 0; k < mixture.names.size(); ++k)
            words += fmt::format("\n{}  {}: {}", indent, mixture.names[k], std::visit(inner, mixture.mixtures[k].kind));
        return words;
    }
};

} // namespace

std::string words_of_mixture(const MixtureDescription& mixture)
{
    std::string words = std::visit(Words{""}, mixture.kind) + "\n";
    if (!depends_on_frame(mixture)) return words;
    if (mixture.decided.each) return words + "decided anew in each frame of a film\n";
    if (mixture.decided.frame == -1) return words + "decided in the last frame of a film and kept\n";
    return words + fmt::format("decided in frame {} of a film and kept\n", mixture.decided.frame);
}

std::optional<std::map<std::string, double>> expected_fractions(const MixtureDescription& mixture)
{
    return std::visit(Expectation{}, mixture.kind);
}

} // namespace scree
