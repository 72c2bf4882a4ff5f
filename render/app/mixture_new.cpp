#include "render/app/mixture_command.h"

#include "base/atomic_file.h"
#include "base/json.h"
#include "base/text.h"
#include "mixtures/describe_mixture.h"
#include "mixtures/read_mixture.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <map>
#include <memory>

namespace scree {

namespace {

using nlohmann::ordered_json;

struct NewOptions {
    std::vector<std::string> words; // the types, for most kinds with an optional number each
    std::map<std::string, std::string> values; // by JSON key
    std::string output;
};

struct Flag {
    const char *name, *key, *help;
};

struct NewKind {
    const char *kind, *help, *word_name, *word_help;
    const char* number_key; // JSON key of the numbers after the words' "="; null: no numbers
    std::vector<Flag> flags;
};

const Flag seed{"--seed", "seed", "Another seed gives another arrangement"};
const Flag offset{"--offset", "offset", "x,y,z: shifts the pattern"};

std::vector<NewKind> new_kinds()
{
    return {
        {"single", "One type for all", "TYPE", "The grain type", nullptr, {}},
        {"random",
         "Each sphere draws its type",
         "TYPE[=WEIGHT]",
         "The grain types with their weights (all 1 when left out)",
         "weights",
         {{"--by", "by",
           "number (each sphere draws independently) or volume (fractions by volume, exact to about the smallest "
           "sphere)"},
          seed}},
        {"perlin",
         "Patches of Perlin noise",
         "TYPE[=FRACTION]",
         "The grain types, from low noise to high",
         "fraction",
         {{"--scale", "scale", "Width of the noise's lattice; one number or x,y,z (required)"},
          {"--threshold", "threshold", "Noise (-1..1) where the next type begins; one fewer than types"},
          {"--fraction", "fraction", "Fraction of the first type, or of each: T,U,...; Scree computes the thresholds"},
          {"--octaves", "octaves", "Number of layers of ever finer noise"},
          {"--lacunarity", "lacunarity", "Frequency of an octave over the frequency of the previous octave"},
          {"--gain", "gain", "Amplitude of an octave over the amplitude of the previous octave"},
          offset,
          seed}},
        {"checkerboard",
         "Cells of alternating types",
         "TYPE",
         "The grain types",
         nullptr,
         {{"--cell", "cell", "Edge of a cell; one number or x,y,z (required)"},
          {"--offset", "offset", "Position of a corner: x,y,z"},
          {"--rotation", "rotation", "Degrees about x, then y, then z: x,y,z"}}},
        {"layers",
         "Layers along a direction",
         "TYPE[=THICKNESS]",
         "The layers in order",
         "thicknesses",
         {{"--thickness", "thicknesses", "Thickness of all layers, or of each: T,U,..."},
          {"--direction", "direction", "x,y,z: from the first layer to the next (0,0,1 when left out)"},
          {"--offset", "offset", "Where the first layer begins along the direction"},
          {"--repeat", "repeat", "false: the layers do not repeat, and the first and the last have no end"},
          {"--jitter", "jitter/amplitude", "Amplitude of the noise that moves the faces"},
          {"--jitter-scale", "jitter/scale", "Width of the lattice of this noise"},
          {"--jitter-seed", "jitter/seed", "Seed of this noise"}}},
        {"radius",
         "The sphere's radius decides",
         "TYPE",
         "The grain types, from small to large",
         nullptr,
         {{"--thresholds", "thresholds", "Radii where the next type begins: R,S,... (required)"}}},
        {"grid",
         "Each sphere draws its type by concentrations in OpenVDB grids",
         "TYPE=FILE[:GRID]",
         "The grain types, each with its field",
         nullptr,
         {{"--rest", "rest", "Type for the probability that the concentrations leave below 1"}, seed}},
        {"blend",
         "One mixture chooses between others",
         "NAME=TYPE|FILE.json",
         "The mixtures, each with the name that the mixture of --by uses for it",
         nullptr,
         {{"--by", "by", "FILE.json: the mixture that chooses; its types are the NAMEs (required)"}}},
        {"explicit",
         "The dump or a table gives each sphere's type",
         "NUMBER=TYPE",
         "The grain type of each type number (the scene's map when left out)",
         nullptr,
         {{"--table", "table", "A table of types by row or id: .csv or .vdb"},
          {"--column", "column", "The table's column (or attribute) of types"},
          {"--id", "id", "The table's column of ids"}}},
    };
}

/// "3" as 3, "1,2" as [1, 2], "false" as false, else the text.
ordered_json value_of(const std::string& text)
{
    if (text == "true" || text == "false") return text == "true";
    ordered_json list = ordered_json::array();
    for (size_t begin = 0; begin <= text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        const auto number = to_double(text.substr(begin, end - begin));
        if (!number) return text;
        const auto whole = to_int64(text.substr(begin, end - begin));
        list.push_back(whole ? ordered_json(*whole) : ordered_json(*number));
        begin = end + 1;
    }
    return list.size() == 1 ? list[0] : list;
}

std::pair<std::string, std::string> split_word(const std::string& word, const NewKind& kind, bool needs_value)
{
    const size_t equal = word.find('=');
    if (equal == std::string::npos ? needs_value : equal == 0 || equal + 1 == word.size())
        throw InputError("scree mixture new " + std::string(kind.kind), in_quotes(word), kind.word_name);
    if (equal == std::string::npos) return {word, ""};
    return {word.substr(0, equal), word.substr(equal + 1)};
}

ordered_json mixture_or_type(const std::string& text)
{
    if (lower_case(text).ends_with(".json")) return {{"file", text}};
    return text;
}

void add_types(const NewKind& kind, const NewOptions& options, ordered_json& json)
{
    const std::string place = "scree mixture new " + std::string(kind.kind);
    ordered_json numbers = ordered_json::array();
    for (const std::string& word : options.words) {
        const auto [name, number] = split_word(word, kind, false);
        json["types"].push_back(name);
        if (number.empty()) continue;
        if (!kind.number_key || !to_double(number)) throw InputError(place, in_quotes(word), kind.word_name);
        numbers.push_back(*to_double(number));
    }
    if (numbers.empty()) return;
    if (numbers.size() != options.words.size())
        throw InputError(place, fmt::format("{} of {} types with a number", numbers.size(), options.words.size()),
                         "a number for each, or for none");
    if (options.values.contains(kind.number_key))
        throw InputError(place, "numbers after the types and an option for the same numbers", "only one of the two");
    json[kind.number_key] = numbers;
}

ordered_json json_of(const NewKind& kind, const NewOptions& options)
{
    const std::string name = kind.kind;
    ordered_json json;
    json["kind"] = name;
    if (name == "single") {
        if (options.words.size() != 1)
            throw InputError("scree mixture new single", fmt::format("{} types", options.words.size()), "one type");
        json["type"] = options.words[0];
    } else if (name == "grid") {
        for (const std::string& word : options.words) {
            const auto [type, field] = split_word(word, kind, true);
            const size_t colon = field.rfind(':');
            ordered_json entry{{"type", type}, {"file", field.substr(0, colon)}};
            if (colon != std::string::npos) entry["grid"] = field.substr(colon + 1);
            json["fields"].push_back(entry);
        }
    } else if (name == "blend") {
        for (const std::string& word : options.words) {
            const auto [key, mixture] = split_word(word, kind, true);
            json["mixtures"][key] = mixture_or_type(mixture);
        }
    } else if (name == "explicit") {
        for (const std::string& word : options.words) {
            const auto [number, type] = split_word(word, kind, true);
            json["types"][number] = type;
        }
    } else {
        add_types(kind, options, json);
    }
    for (const auto& [key, text] : options.values) {
        const bool is_text = key == "rest" || key == "table" || key == "column" || key == "id";
        ordered_json& value = json[ordered_json::json_pointer("/" + key)];
        value = name == "blend" ? mixture_or_type(text) : is_text ? ordered_json(text) : value_of(text);
    }
    return json;
}

void run(const NewKind& kind, const NewOptions& options)
{
    // The reader checks the mixture now, so that no later command refuses the file; write_mixture gives the usual form.
    const std::string name = "scree mixture new " + std::string(kind.kind);
    const JsonDocument document = JsonDocument::parse(json_of(kind, options).dump(), name, ".");
    const MixtureDescription mixture = read_mixture(document.root());
    const std::filesystem::path output = options.output;
    const std::string text = write_mixture(mixture, output.parent_path()).dump(2) + "\n";
    if (options.output.empty()) {
        fmt::print("{}", text);
        return;
    }
    AtomicFile file(output);
    std::ofstream out(file.temporary(), std::ios::binary);
    if (!(out << text).flush())
        throw InputError(options.output, "a file that cannot be written", "free space and permission to write");
    out.close();
    file.commit();
    fmt::print("{}: {}", options.output, words_of_mixture(mixture));
}

} // namespace

void add_mixture_new_command(CLI::App& mixture)
{
    CLI::App* command = mixture.add_subcommand("new", "Write a mixture file");
    command->require_subcommand(1);
    for (const NewKind& kind : new_kinds()) {
        auto options = std::make_shared<NewOptions>();
        CLI::App* sub = command->add_subcommand(kind.kind, kind.help);
        CLI::Option* words = sub->add_option(kind.word_name, options->words, kind.word_help);
        if (std::string(kind.kind) != "explicit") words->required();
        sub->add_option("-o,--output", options->output, "The file to write (standard output when left out)");
        for (const Flag& flag : kind.flags) {
            const std::string key = flag.key;
            const auto keep = [options, key](const std::string& text) { options->values[key] = text; };
            sub->add_option_function<std::string>(flag.name, keep, flag.help);
        }
        sub->callback([options, kind] { run(kind, *options); });
    }
}

} // namespace scree
