// Mixtures as JSON: every generated mixture survives the round trip and evaluates the same; a damaged mixture can only
// cause an InputError.

#include "base/json.h"
#include "mixtures/describe_mixture.h"
#include "mixtures/read_mixture.h"
#include "tests/builders/test_files.h"
#include "tests/mixtures/mixture_builders.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace scree {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::vector<std::string> scene_types{"a", "b", "c", "d"};

/// Generates mixtures of every kind, nested up to a depth; every option occurs in some of them.
class Generator {
public:
    explicit Generator(uint64_t seed) : n_(seed) {}

    json mixture(int depth, const std::vector<std::string>& types)
    {
        json m;
        switch (n_.below(depth > 0 ? 10 : 9)) {
        case 0: return one_of(types);
        case 1: m = {{"kind", "single"}, {"type", one_of(types)}}; break;
        case 2:
            m = {{"kind", "explicit"}, {"types", {{"1", one_of(types)}, {"2", one_of(types)}, {"3", one_of(types)}}}};
            if (flip()) m["table"] = "table.csv";
            break;
        case 3: {
            m = {{"kind", "random"}, {"types", some_of(types)}};
            if (flip()) m["weights"] = numbers(m["types"].size(), 0.1, 5);
            if (flip()) m["by"] = flip() ? "volume" : "number";
            seed(m);
            break;
        }
        case 4: {
            m = {{"kind", "perlin"}, {"types", some_of(types)}};
            noise(m);
            const size_t n = m["types"].size();
            if (flip())
                m["threshold"] = sorted(numbers(n - 1, -0.5, 0.5));
            else if (flip())
                m["fraction"] = numbers(n, 0.1, 1);
            else if (n == 2)
                m["fraction"] = n_.unit();
            break;
        }
        case 5:
            m = {{"kind", "checkerboard"}, {"types", some_of(types)}, {"cell", lengths()}};
            if (flip()) m["offset"] = numbers(3, -5, 5);
            if (flip()) m["rotation"] = numbers(3, -180, 180);
            break;
        case 6:
            m = {{"kind", "layers"}, {"types", some_of(types)}};
            if (flip())
                m["thicknesses"] = 0.1 + n_.unit();
            else
                m["thicknesses"] = numbers(m["types"].size(), 0.1, 4);
            if (flip()) m["direction"] = numbers(3, 0.1, 1);
            if (flip()) m["offset"] = number(-3, 3);
            if (flip()) m["repeat"] = flip();
            if (flip()) {
                m["jitter"]["amplitude"] = number(0.1, 2);
                noise(m["jitter"]);
            }
            break;
        case 7:
            m = {{"kind", "radius"}, {"types", some_of(types)}};
            m["thresholds"] = sorted(numbers(m["types"].size() - 1, 0.2, 3));
            break;
        case 8:
            m = {{"kind", "grid"}, {"fields", {{{"type", one_of(types)}, {"file", "ramp.vdb"}}}}};
            if (flip()) m["fields"].push_back({{"type", one_of(types)}, {"file", "ramp.vdb"}, {"grid", "c"}});
            if (flip()) m["rest"] = one_of(types);
            seed(m);
            break;
        default: {
            std::vector<std::string> names{"first", "second"};
            if (flip()) names.push_back("third");
            m["kind"] = "blend";
            m["by"] = mixture(depth - 1, names);
            for (const std::string& name : names) m["mixtures"][name] = mixture(depth - 1, types);
            break;
        }
        }
        return m;
    }

    test::Numbers& raw() { return n_; }
    bool flip() { return n_.below(2) == 0; }

private:
    double number(double lo, double hi) { return lo + (hi - lo) * n_.unit(); }
    json numbers(size_t count, double lo, double hi)
    {
        json list = json::array();
        for (size_t i = 0; i < count; ++i) list.push_back(number(lo, hi));
        return list;
    }
    static json sorted(json list)
    {
        std::sort(list.begin(), list.end());
        return list;
    }
    json lengths() { return flip() ? json(number(0.5, 6)) : numbers(3, 0.5, 6); }
    std::string one_of(const std::vector<std::string>& types) { return types[n_.below(types.size())]; }
    json some_of(const std::vector<std::string>& types)
    {
        json list;
        const uint64_t count = 1 + n_.below(4);
        for (uint64_t i = 0; i < count; ++i) list.push_back(one_of(types));
        return list;
    }
    void seed(json& m)
    {
        if (flip()) m["seed"] = n_.below(1000);
    }
    void noise(json& m)
    {
        m["scale"] = lengths();
        if (flip()) m["offset"] = numbers(3, -3, 3);
        if (flip()) m["octaves"] = 1 + n_.below(4);
        if (flip()) m["lacunarity"] = number(1.5, 3);
        if (flip()) m["gain"] = number(0.2, 0.8);
        seed(m);
    }
    test::Numbers n_;
};

class MixtureJson : public testing::Test {
protected:
    MixtureJson() : frame_(test::random_spheres(300, 20, 0.5))
    {
        test::write_ramp(folder_.path("ramp.vdb"), 12);
        std::string table = "id,type\n";
        for (size_t i = 0; i < frame_.size(); ++i) table += fmt::format("{},{}\n", frame_.id[i], 1 + i % 3);
        folder_.write("table.csv", table);
    }
    MixtureDescription read(const std::string& text)
    {
        return read_mixture(JsonDocument::parse(text, "m.json", folder_.path()).root(), scene_types);
    }
    std::vector<uint32_t> evaluate(const MixtureDescription& description)
    {
        return test::types_of(
            *make_mixture(description, {scene_types, {{1, "a"}, {2, "b"}, {3, "c"}}, &frame_, false, "dump"}), frame_);
    }
    std::string error(const std::string& text)
    {
        const auto found = test::input_error_of([&] { evaluate(read(text)); });
        return found ? found->what() : "none";
    }
    test::TemporaryFolder folder_;
    ParticleFrame frame_;
};

TEST_F(MixtureJson, GeneratedMixturesSurviveTheRoundTrip)
{
    for (uint64_t seed = 0; seed < 200; ++seed) {
        const std::string text = Generator(seed).mixture(3, scene_types).dump();
        const MixtureDescription first = read(text);
        const std::string written = write_mixture(first, folder_.path()).dump();
        const MixtureDescription second = read(written);
        EXPECT_EQ(write_mixture(second, folder_.path()).dump(), written) << text;
        EXPECT_EQ(evaluate(first), evaluate(second)) << text;
        EXPECT_EQ(words_of_mixture(first), words_of_mixture(second));
    }
}

TEST_F(MixtureJson, ExpectedFractionsAreWhatSpheresShow)
{
    const ParticleFrame frame = test::random_spheres(100000, 2000);
    int known = 0;
    for (uint64_t seed = 0; seed < 150; ++seed) {
        const std::string text = Generator(seed).mixture(2, scene_types).dump();
        const MixtureDescription description = read(text);
        const auto expected = expected_fractions(description);
        if (!expected || text.find("by\":{\"by") != std::string::npos) continue;
        // Where the position decides both in `by` and in the chosen mixture, the fractions are not a product.
        if (text.find("mixtures") != std::string::npos) continue;
        ++known;
        std::vector<double> count(4, 0);
        const auto mixture = make_mixture(description, {scene_types, {}, &frame, false, ""});
        for (const uint32_t type : test::types_of(*mixture, frame)) count[type] += 1;
        double sum = 0;
        for (size_t k = 0; k < 4; ++k) {
            const auto it = expected->find(scene_types[k]);
            const double f = it == expected->end() ? 0 : it->second;
            sum += f;
            EXPECT_NEAR(count[k] / double(frame.size()), f, 5 * std::sqrt(f * (1 - f) / 50000) + 1e-9) << text;
        }
        EXPECT_NEAR(sum, 1, 1e-9);
    }
    EXPECT_GT(known, 40);
}

TEST_F(MixtureJson, DamagedMixturesAreInputErrorsAndNeverWorse)
{
    int errors = 0;
    for (uint64_t seed = 0; seed < 1500; ++seed) {
        Generator generator(1000 + seed);
        test::Numbers& n = generator.raw();
        std::string text;
        json tree = generator.mixture(2, scene_types);
        if (generator.flip()) { // change a value of the tree
            json flat = tree.flatten();
            const auto keys = flat.items();
            auto it = keys.begin();
            for (uint64_t k = n.below(flat.size()); k > 0; --k) ++it;
            const std::vector<json> values{nullptr,
                                           -1,
                                           0,
                                           1e308,
                                           -1e308,
                                           1e-320,
                                           "",
                                           "zz",
                                           json::array(),
                                           json::object(),
                                           true,
                                           std::numeric_limits<uint64_t>::max(),
                                           json::array({1, 2}),
                                           "a"};
            flat[it.key()] = values[n.below(values.size())];
            try {
                tree = flat.unflatten();
            } catch (const json::exception&) {
            }
            text = tree.dump();
        } else { // change bytes of the text
            text = tree.dump();
            for (uint64_t k = 1 + n.below(4); k > 0 && !text.empty(); --k) {
                const size_t at = n.below(text.size());
                switch (n.below(3)) {
                case 0: text.erase(at, 1 + n.below(5)); break;
                case 1: text[at] = static_cast<char>(n.below(256)); break;
                default:
                    text.insert(text.begin() + static_cast<std::ptrdiff_t>(at), "{}[],:\"0-9.e"[n.below(12)]);
                    break;
                }
            }
        }
        try {
            const MixtureDescription description = read(text);
            words_of_mixture(description);
            expected_fractions(description);
            for (const uint32_t type : evaluate(description)) ASSERT_LT(type, scene_types.size()) << text;
        } catch (const InputError&) {
            ++errors;
        } catch (const std::exception& other) {
            FAIL() << other.what() << " of " << text;
        }
    }
    EXPECT_GT(errors, 500);
}

TEST_F(MixtureJson, ErrorsSayWhereAndSuggest)
{
    EXPECT_THAT(error(R"({"kind": "randon", "types": ["a"]})"), HasSubstr("did you mean 'random'"));
    EXPECT_THAT(error(R"({"kind": "random", "types": ["a"], "wieghts": [1]})"), HasSubstr("did you mean 'weights'"));
    EXPECT_THAT(error(R"({"kind": "random", "types": ["a", "e"]})"), HasSubstr("m.json: /types/1"));
    EXPECT_THAT(error(R"({"kind": "random", "types": ["a", "b"], "weights": [0, 0]})"), HasSubstr("a sum above 0"));
    EXPECT_THAT(error(R"({"kind": "random", "types": ["a", "b"], "weights": [1]})"), HasSubstr("a list of 2"));
    EXPECT_THAT(error(R"({"kind": "perlin", "types": ["a", "b"]})"), HasSubstr("scale"));
    EXPECT_THAT(error(R"({"kind": "perlin", "types": ["a", "b"], "scale": 1, "threshold": 0, "fraction": 0.5})"),
                HasSubstr("either"));
    EXPECT_THAT(error(R"({"kind": "radius", "types": ["a", "b", "c"], "thresholds": [2, 1]})"), HasSubstr("ascending"));
    EXPECT_THAT(error(R"({"kind": "layers", "types": ["a"], "thicknesses": 0})"), HasSubstr("above 0"));
    EXPECT_THAT(error(R"({"kind": "layers", "types": ["a"], "thicknesses": 1, "direction": [0, 0, 0]})"),
                HasSubstr("direction"));
    EXPECT_THAT(error(R"({"kind": "blend", "by": "rimm", "mixtures": {"rim": "a", "core": "b"}})"),
                HasSubstr("did you mean 'rim'"));
    EXPECT_THAT(
        error(R"({"kind": "blend", "by": "rim", "mixtures": {"rim": {"kind": "single", "type": "a", "frame": 0}}})"),
        HasSubstr("frame"));
    EXPECT_THAT(error(R"({"kind": "explicit", "types": {"1": "a", "2": "b"}})"), HasSubstr("type 3"));
    EXPECT_EQ(error(R"({"kind": "explicit"})"), "none");
}

TEST_F(MixtureJson, FilesInsideFiles)
{
    std::filesystem::create_directory(folder_.path("sub"));
    folder_.write("sub/grid.json",
                  R"({"kind": "grid", "fields": [{"type": "a", "file": "../ramp.vdb"}], "rest": "b", "frame": 3})");
    const MixtureDescription description = read(R"({"file": "sub/grid.json"})");
    EXPECT_EQ(description.decided.frame, 3);
    EXPECT_EQ(read(R"({"file": "sub/grid.json", "frame": "each"})").decided, (DecisionFrame{true, -1}));
    EXPECT_EQ(evaluate(description),
              evaluate(read(R"({"kind": "grid", "fields": [{"type": "a", "file": "ramp.vdb"}], "rest": "b"})")));
    EXPECT_EQ(write_mixture(description, folder_.path("sub"))["fields"][0]["file"], "../ramp.vdb");

    folder_.write("loop.json", R"({"kind": "blend", "by": "x", "mixtures": {"x": {"file": "loop.json"}}})");
    EXPECT_THAT(error(R"({"file": "loop.json"})"), HasSubstr("circle"));
    EXPECT_THAT(error(R"({"file": "none.json"})"), HasSubstr("none.json"));

    const std::string scene =
        folder_.write("scene.json", R"({"grains": {"types": {}, "mixture": {"kind": "single", "type": "b"}}})");
    EXPECT_EQ(types_named(read_mixture_file(scene)), std::vector<std::string>{"b"});
}

TEST_F(MixtureJson, NestingHasAnEnd)
{
    const auto inside = [](const std::string& inner) {
        return fmt::format(R"({{"kind": "blend", "by": "x", "mixtures": {{"x": {}}}}})", inner);
    };
    std::string text = "\"a\"";
    for (int i = 0; i < 150; ++i) text = inside(text);
    EXPECT_EQ(evaluate(read(text)), std::vector<uint32_t>(frame_.size(), 0));
    for (int i = 0; i < 100; ++i) text = inside(text);
    EXPECT_THAT(error(text), HasSubstr("deep"));
}

/// Checks for every object of the tree that the schema knows all its keys, and that its required keys are present.
void check_against_schema(const json& value, const json& schema, const std::string& text)
{
    if (value.is_string()) return;
    const std::string kind = value.contains("kind") ? value["kind"].get<std::string>() : "file";
    const json& definition = schema["$defs"][kind];
    for (const auto& [key, inner] : value.items())
        EXPECT_TRUE(definition["properties"].contains(key)) << key << " of " << text;
    for (const auto& key : definition["required"]) EXPECT_TRUE(value.contains(key)) << key << " of " << text;
    if (value.contains("jitter")) {
        const json& noise = definition["properties"]["jitter"]["properties"];
        for (const auto& [key, inner] : value["jitter"].items()) EXPECT_TRUE(noise.contains(key)) << key;
    }
    if (kind != "blend") return;
    check_against_schema(value["by"], schema, text);
    for (const auto& [name, inner] : value["mixtures"].items()) check_against_schema(inner, schema, text);
}

TEST_F(MixtureJson, TheSchemaKnowsTheKeys)
{
    const json schema = json::parse(test::read_bytes(SCREE_SCHEMA));
    for (const std::string& kind : mixture_kinds) EXPECT_TRUE(schema["$defs"].contains(kind));
    for (uint64_t seed = 0; seed < 200; ++seed) {
        const std::string text = Generator(seed).mixture(2, scene_types).dump();
        check_against_schema(json::parse(text), schema, text);
        check_against_schema(json::parse(write_mixture(read(text), folder_.path()).dump()), schema, text);
    }
    // The reverse: for an unknown key the reader lists all keys that it knows, and the schema must have no others.
    for (const auto& [kind, start] :
         std::map<std::string, std::string>{{"single", R"("type": "a")"},
                                            {"explicit", R"("table": "t.csv")"},
                                            {"random", R"("types": ["a"])"},
                                            {"perlin", R"("types": ["a"], "scale": 1)"},
                                            {"checkerboard", R"("types": ["a"], "cell": 1)"},
                                            {"layers", R"("types": ["a"], "thicknesses": 1)"},
                                            {"radius", R"("types": ["a"], "thresholds": [])"},
                                            {"grid", R"("fields": [{"type": "a", "file": "f"}])"},
                                            {"blend", R"("by": "x", "mixtures": {"x": "a"})"}}) {
        const auto unknown =
            test::input_error_of([&] { read(fmt::format(R"({{"kind": "{}", {}, "zz": 1}})", kind, start)); });
        ASSERT_TRUE(unknown) << kind;
        for (const auto& [key, value] : schema["$defs"][kind]["properties"].items())
            EXPECT_THAT(unknown->expected(), HasSubstr(key)) << kind;
    }
}

} // namespace
} // namespace scree
