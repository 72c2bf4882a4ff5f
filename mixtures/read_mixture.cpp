#include "mixtures/read_mixture.h"

#include "base/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr int64_t largest_seed = int64_t{1} << 53; // every JSON library keeps integers up to this exactly
constexpr size_t deepest = 200;

/// The context of a mixture in the tree: the names that it may choose from, and the files that led to it.
struct Scope {
    const std::vector<std::string>& types;
    std::vector<std::filesystem::path> files;
    size_t depth = 0;
};

double read_positive(const JsonValue& value)
{
    const double x = value.number(0);
    if (x <= 0) value.fail("a number above 0");
    return x;
}

/// One number for all axes, or three.
Imath::V3d read_lengths(const JsonValue& value)
{
    if (value.is_number()) return Imath::V3d(read_positive(value));
    const auto items = value.array(3, 3);
    return {read_positive(items[0]), read_positive(items[1]), read_positive(items[2])};
}

std::string read_type(const JsonValue& value, const Scope& scope)
{
    const std::string name = value.string();
    if (name.empty()) value.fail("the name of a grain type");
    if (scope.types.empty() || std::ranges::find(scope.types, name) != scope.types.end()) return name;
    const std::string nearest = did_you_mean(name, scope.types);
    value.fail(fmt::format("one of {}", fmt::join(scope.types, ", ")), nearest.empty() ? "" : nearest.substr(2));
}

std::vector<std::string> read_types(JsonObject& object, const Scope& scope, size_t least = 1)
{
    std::vector<std::string> names;
    for (const JsonValue& item : object.require("types").array(least, 65535)) names.push_back(read_type(item, scope));
    return names;
}

std::vector<double> read_numbers(const JsonValue& value, size_t count, double lo)
{
    std::vector<double> numbers;
    if (value.is_number() && count == 1) return {value.number(lo)};
    for (const JsonValue& item : value.array(count, count)) numbers.push_back(item.number(lo));
    return numbers;
}

std::vector<double> read_ascending(const JsonValue& value, size_t count, double lo)
{
    std::vector<double> numbers = read_numbers(value, count, lo);
    if (!std::ranges::is_sorted(numbers)) value.fail("ascending numbers");
    return numbers;
}

/// Finite, not below 0, and with a finite sum above 0.
std::vector<double> read_weights(const JsonValue& value, size_t count)
{
    std::vector<double> weights = read_numbers(value, count, 0);
    double sum = 0;
    for (const double w : weights) sum += w;
    if (!(sum > 0) || !std::isfinite(sum)) value.fail("numbers with a sum above 0");
    return weights;
}

uint64_t read_seed(JsonObject& object)
{
    const auto seed = object.find("seed");
    return seed ? static_cast<uint64_t>(seed->integer(0, largest_seed)) : 0;
}

NoiseOptions read_noise(JsonObject& object)
{
    NoiseOptions noise;
    noise.scale = read_lengths(object.require("scale"));
    if (const auto offset = object.find("offset")) noise.offset = offset->vec3();
    if (const auto octaves = object.find("octaves")) noise.octaves = static_cast<int>(octaves->integer(1, 32));
    if (const auto lacunarity = object.find("lacunarity")) noise.lacunarity = lacunarity->number(1, 16);
    if (const auto gain = object.find("gain")) noise.gain = gain->number(0, 1);
    noise.seed = read_seed(object);
    return noise;
}

ExplicitDescription read_explicit(JsonObject& object, const Scope& scope)
{
    ExplicitDescription mixture;
    if (const auto types = object.find("types")) {
        JsonObject map = types->object();
        for (const std::string& number : map.take_keys()) mixture.types[number] = read_type(map.require(number), scope);
    }
    if (const auto table = object.find("table")) {
        mixture.table = table->path();
        if (const auto column = object.find("column")) mixture.column = column->string();
        if (const auto id = object.find("id")) mixture.id = id->string();
    }
    return mixture;
}

RandomDescription read_random(JsonObject& object, const Scope& scope)
{
    RandomDescription mixture;
    mixture.types = read_types(object, scope);
    mixture.weights.assign(mixture.types.size(), 1);
    if (const auto weights = object.find("weights")) mixture.weights = read_weights(*weights, mixture.types.size());
    if (const auto by = object.find("by")) mixture.by = by->choice(random_by_names);
    if (mixture.by == RandomBy::volume && mixture.types.size() > 1024)
        object.value().fail("at most 1024 types by volume");
    mixture.seed = read_seed(object);
    return mixture;
}

PerlinDescription read_perlin(JsonObject& object, const Scope& scope)
{
    PerlinDescription mixture;
    mixture.types = read_types(object, scope);
    mixture.noise = read_noise(object);
    const auto threshold = object.find("threshold"), fraction = object.find("fraction");
    if (threshold && fraction) object.value().fail("either 'threshold' or 'fraction'");
    if (threshold) {
        mixture.threshold =
            read_ascending(*threshold, mixture.types.size() - 1, -std::numeric_limits<double>::infinity());
        if (mixture.types.size() == 1) mixture.fraction = {1};
    } else if (fraction && fraction->is_number() && mixture.types.size() == 2) {
        const double first = fraction->number(0, 1);
        mixture.fraction = {first, 1 - first};
    } else if (fraction) {
        mixture.fraction = read_weights(*fraction, mixture.types.size());
    } else {
        mixture.fraction.assign(mixture.types.size(), 1);
    }
    return mixture;
}

CheckerboardDescription read_checkerboard(JsonObject& object, const Scope& scope)
{
    CheckerboardDescription mixture;
    mixture.types = read_types(object, scope);
    mixture.board.cell = read_lengths(object.require("cell"));
    if (const auto offset = object.find("offset")) mixture.board.offset = offset->vec3();
    if (const auto rotation = object.find("rotation")) {
        mixture.board.rotation = rotation->vec3();
        for (int a = 0; a < 3; ++a)
            if (std::abs(mixture.board.rotation[a]) > 1e6) rotation->fail("angles in degrees, within 1e6");
    }
    return mixture;
}

LayersDescription read_layers(JsonObject& object, const Scope& scope)
{
    LayersDescription mixture;
    mixture.types = read_types(object, scope);
    const JsonValue thicknesses = object.require("thicknesses");
    if (thicknesses.is_number())
        mixture.thicknesses.assign(mixture.types.size(), read_positive(thicknesses));
    else
        for (const JsonValue& item : thicknesses.array(mixture.types.size(), mixture.types.size()))
            mixture.thicknesses.push_back(read_positive(item));
    if (const auto direction = object.find("direction")) {
        mixture.direction = direction->vec3();
        if (!(mixture.direction.length() > 0) || !std::isfinite(mixture.direction.length()))
            direction->fail("a direction that is not 0");
    }
    if (const auto offset = object.find("offset")) mixture.offset = offset->number();
    if (const auto repeat = object.find("repeat")) mixture.repeat = repeat->boolean();
    if (const auto jitter = object.find("jitter")) {
        JsonObject noise = jitter->object();
        mixture.jitter = noise.require("amplitude").number(0);
        mixture.noise = read_noise(noise);
        noise.done();
    }
    return mixture;
}

RadiusDescription read_radius(JsonObject& object, const Scope& scope)
{
    RadiusDescription mixture;
    mixture.types = read_types(object, scope);
    mixture.thresholds = read_ascending(object.require("thresholds"), mixture.types.size() - 1, 0);
    return mixture;
}

GridDescription read_grid(JsonObject& object, const Scope& scope)
{
    GridDescription mixture;
    for (const JsonValue& item : object.require("fields").array(1)) {
        JsonObject entry = item.object();
        GridDescription::Field field{read_type(entry.require("type"), scope), entry.require("file").path(), ""};
        if (const auto grid = entry.find("grid")) field.grid = grid->string();
        entry.done();
        mixture.fields.push_back(field);
    }
    if (const auto rest = object.find("rest")) mixture.rest = read_type(*rest, scope);
    mixture.seed = read_seed(object);
    return mixture;
}

MixtureDescription read_any(const JsonValue& json, const Scope& scope);

BlendDescription read_blend(JsonObject& object, const Scope& scope)
{
    BlendDescription mixture;
    Scope inner{scope.types, scope.files, scope.depth + 1};
    const JsonValue mixtures = object.require("mixtures");
    JsonObject map = mixtures.object();
    mixture.names = map.take_keys();
    if (mixture.names.empty() || mixture.names.size() > 65535) mixtures.fail("1 to 65535 mixtures by name");
    for (const std::string& name : mixture.names) mixture.mixtures.push_back(read_any(map.require(name), inner));
    const Scope names{mixture.names, scope.files, scope.depth + 1};
    mixture.by.push_back(read_any(object.require("by"), names));
    return mixture;
}

/// Reads the mixture of {"file": F}.
MixtureDescription read_reference(const std::filesystem::path& file, const Scope& scope, const JsonValue* where)
{
    const std::filesystem::path path = std::filesystem::absolute(file).lexically_normal();
    if (std::ranges::find(scope.files, path) != scope.files.end()) {
        throw InputError(where ? where->place() : file.string(), "a mixture inside itself: " + file.string(),
                         "files that do not refer to each other in a circle");
    }
    const JsonDocument document = JsonDocument::load(file);
    Scope inner{scope.types, scope.files, scope.depth + 1};
    inner.files.push_back(path);
    const JsonValue root = document.root();
    if (root.is_object()) {
        JsonObject scene = root.object();
        if (const auto grains = scene.find("grains")) { // a scene: its mixture is used
            JsonObject object = grains->object();
            if (const auto mixture = object.find("mixture")) return read_any(*mixture, inner);
            MixtureDescription plain;
            plain.kind = ExplicitDescription{};
            plain.place = grains->place();
            return plain;
        }
    }
    return read_any(root, inner);
}

void read_decision(JsonObject& object, const Scope& scope, DecisionFrame& decided)
{
    // A film has one deciding frame: it is read at the root only, also when the root refers to a file.
    if (scope.depth > scope.files.size()) return;
    const auto frame = object.find("frame");
    if (!frame) return;
    decided = {};
    if (frame->is_string())
        decided.each = frame->choice({"each"}) == 0;
    else
        decided.frame = frame->integer(-largest_seed, largest_seed);
}

MixtureDescription read_any(const JsonValue& json, const Scope& scope)
{
    MixtureDescription mixture;
    mixture.place = json.place();
    if (scope.depth > deepest) json.fail(fmt::format("mixtures nested at most {} deep", deepest));
    if (json.is_string()) {
        mixture.kind = SingleDescription{read_type(json, scope)};
        return mixture;
    }
    JsonObject object = json.object();
    if (const auto schema = object.find("$schema")) schema->string();
    if (const auto file = object.find("file")) {
        mixture = read_reference(file->path(), scope, &*file);
        read_decision(object, scope, mixture.decided);
        object.done();
        return mixture;
    }
    read_decision(object, scope, mixture.decided);
    const std::string& kind = mixture_kinds[object.require("kind").choice(mixture_kinds)];
    if (kind == SingleDescription::name)
        mixture.kind = SingleDescription{read_type(object.require("type"), scope)};
    else if (kind == ExplicitDescription::name)
        mixture.kind = read_explicit(object, scope);
    else if (kind == RandomDescription::name)
        mixture.kind = read_random(object, scope);
    else if (kind == PerlinDescription::name)
        mixture.kind = read_perlin(object, scope);
    else if (kind == CheckerboardDescription::name)
        mixture.kind = read_checkerboard(object, scope);
    else if (kind == LayersDescription::name)
        mixture.kind = read_layers(object, scope);
    else if (kind == RadiusDescription::name)
        mixture.kind = read_radius(object, scope);
    else if (kind == GridDescription::name)
        mixture.kind = read_grid(object, scope);
    else if (kind == BlendDescription::name)
        mixture.kind = read_blend(object, scope);
    else
        throw InputError(json.place(), "kind '" + kind + "'", "a kind that can be read");
    object.done();
    return mixture;
}

} // namespace

MixtureDescription read_mixture(const JsonValue& json, const std::vector<std::string>& types)
{
    return read_any(json, {types, {}});
}

MixtureDescription read_mixture_file(const std::filesystem::path& file, const std::vector<std::string>& types)
{
    return read_reference(file, {types, {}}, nullptr);
}

} // namespace scree
