#include "base/json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

namespace scree {

using nlohmann::json;

struct JsonValue::Root {
    json tree;
    std::string name;
    std::filesystem::path folder;
    std::map<std::string, std::string> origins; ///< by path, of the values that do not come from the file
};

namespace {

/// "line L, column C" of a byte offset (1-based, as nlohmann counts).
std::string line_and_column(const std::string& text, size_t byte)
{
    const size_t end = std::min(byte > 0 ? byte - 1 : 0, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
    const size_t newline = text.rfind('\n', end > 0 ? end - 1 : 0);
    const size_t column = (newline == std::string::npos || newline >= end) ? end + 1 : end - newline;
    return fmt::format("{}:{}", line, column);
}

std::string key_path(const std::string& path, const std::string& key) { return path + "/" + key; }

} // namespace

bool JsonValue::is_number() const { return value_->is_number(); }
bool JsonValue::is_string() const { return value_->is_string(); }
bool JsonValue::is_array() const { return value_->is_array(); }
bool JsonValue::is_object() const { return value_->is_object(); }

double JsonValue::number(double lo, double hi) const
{
    const double inf = std::numeric_limits<double>::infinity();
    std::string expected = "a number";
    if (lo > -inf && hi < inf)
        expected = fmt::format("a number in {}..{}", lo, hi);
    else if (lo > -inf)
        expected = fmt::format("a number of at least {}", lo);
    if (!value_->is_number()) fail(expected);
    const double x = value_->get<double>();
    if (!std::isfinite(x) || x < lo || x > hi) fail(expected);
    return x;
}

int64_t JsonValue::integer(int64_t lo, int64_t hi) const
{
    const std::string expected = fmt::format("a whole number in {}..{}", lo, hi);
    if (!value_->is_number()) fail(expected);
    const double x = value_->get<double>();
    if (x != std::floor(x) || x < static_cast<double>(lo) || x > static_cast<double>(hi)) fail(expected);
    return value_->is_number_integer() ? value_->get<int64_t>() : static_cast<int64_t>(x);
}

bool JsonValue::boolean() const
{
    if (!value_->is_boolean()) fail("true or false");
    return value_->get<bool>();
}

std::string JsonValue::string() const
{
    if (!value_->is_string()) fail("a text in quotes");
    return value_->get<std::string>();
}

size_t JsonValue::choice(const std::vector<std::string>& options) const
{
    const std::string word = string();
    const auto it = std::find(options.begin(), options.end(), word);
    if (it == options.end()) {
        const std::string nearest = did_you_mean(word, options);
        fail("one of " + fmt::format("{}", fmt::join(options, ", ")), nearest.empty() ? "" : nearest.substr(2));
    }
    return static_cast<size_t>(it - options.begin());
}

Imath::V3d JsonValue::vec3() const
{
    const auto items = array(3, 3);
    return {items[0].number(), items[1].number(), items[2].number()};
}

Imath::Color3<double> JsonValue::rgb(double lo, double hi) const
{
    if (is_number()) return Imath::Color3<double>(number(lo, hi));
    if (!is_array() || value_->size() != 3) fail("one number or three (RGB)");
    const auto items = array(3, 3);
    return {items[0].number(lo, hi), items[1].number(lo, hi), items[2].number(lo, hi)};
}

std::vector<JsonValue> JsonValue::array(size_t min_size, size_t max_size) const
{
    if (!value_->is_array() || value_->size() < min_size || value_->size() > max_size) {
        if (min_size == max_size) fail(fmt::format("a list of {}", min_size));
        fail(min_size > 0 ? fmt::format("a list of at least {}", min_size) : "a list");
    }
    std::vector<JsonValue> items;
    for (size_t i = 0; i < value_->size(); ++i) {
        items.push_back(JsonValue(root_, &(*value_)[i], key_path(path_, std::to_string(i))));
    }
    return items;
}

JsonObject JsonValue::object() const
{
    if (!value_->is_object()) fail("an object {...}");
    return JsonObject(*this);
}

std::string JsonValue::place() const
{
    const auto origin = root_->origins.find(path_);
    return origin != root_->origins.end() ? origin->second : root_->name + ": " + (path_.empty() ? "/" : path_);
}
const std::filesystem::path& JsonValue::folder() const { return root_->folder; }

std::filesystem::path JsonValue::path() const
{
    const std::string text = string();
    if (text.empty()) fail("the path of a file");
    const std::filesystem::path path(text);
    return path.is_absolute() ? path : root_->folder / path;
}

std::string JsonValue::text() const
{
    std::string text = value_->dump(-1, ' ', false, json::error_handler_t::replace);
    if (text.size() > 80) text = text.substr(0, 77) + "...";
    return text;
}

void JsonValue::fail(const std::string& expected, const std::string& hint) const
{
    throw InputError(place(), text(), expected, hint);
}

std::optional<JsonValue> JsonObject::find(const std::string& key)
{
    known_.push_back(key);
    const auto it = value_.value_->find(key);
    if (it == value_.value_->end() || it->is_null()) return std::nullopt;
    return JsonValue(value_.root_, &*it, key_path(value_.path_, key));
}

JsonValue JsonObject::require(const std::string& key)
{
    auto value = find(key);
    if (!value) {
        // A misspelt key is the best explanation of a missing key.
        for (const auto& item : value_.value_->items()) {
            if (!did_you_mean(item.key(), {key}).empty() &&
                std::find(known_.begin(), known_.end(), item.key()) == known_.end()) {
                throw InputError(value_.place(), "the key '" + item.key() + "' and no '" + key + "'",
                                 "the key '" + key + "'");
            }
        }
        throw InputError(value_.place(), "no key '" + key + "'", "the key '" + key + "'");
    }
    return *value;
}

std::vector<std::string> JsonObject::take_keys()
{
    std::vector<std::string> keys;
    for (const auto& item : value_.value_->items()) keys.push_back(item.key());
    known_.insert(known_.end(), keys.begin(), keys.end());
    return keys;
}

void JsonObject::done() const
{
    for (const auto& item : value_.value_->items()) {
        if (std::find(known_.begin(), known_.end(), item.key()) == known_.end()) {
            std::vector<std::string> sorted = known_;
            std::sort(sorted.begin(), sorted.end());
            const std::string nearest = did_you_mean(item.key(), known_);
            throw InputError(value_.place(), "the unknown key '" + item.key() + "'",
                             fmt::format("one of {}", fmt::join(sorted, ", ")),
                             nearest.empty() ? "" : nearest.substr(2));
        }
    }
}

JsonDocument::JsonDocument() : root_(std::make_unique<JsonValue::Root>()) {}
JsonDocument::~JsonDocument() = default;
JsonDocument::JsonDocument(JsonDocument&&) noexcept = default;

JsonDocument JsonDocument::parse(const std::string& text, const std::string& name, const std::filesystem::path& folder)
{
    JsonDocument document;
    document.root_->name = name;
    document.root_->folder = folder;
    try {
        document.root_->tree = json::parse(text, nullptr, true, true);
    } catch (const json::parse_error& error) {
        const size_t byte = error.byte;
        const std::string what = error.what();
        const size_t detail = what.rfind("; ");
        throw InputError(name + ":" + line_and_column(text, byte),
                         byte > text.size() ? "the end of the text" : "something that is not JSON", "JSON",
                         detail == std::string::npos ? what : what.substr(detail + 2));
    } catch (const json::exception& error) {
        throw InputError(name, "something that is not JSON", "JSON", error.what());
    }
    return document;
}

JsonDocument JsonDocument::load(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    std::error_code ignored;
    if (!in || std::filesystem::is_directory(file, ignored)) {
        throw InputError(file.string(),
                         std::filesystem::exists(file, ignored) ? "a file that cannot be read" : "no such file",
                         "a JSON file");
    }
    std::ostringstream text;
    text << in.rdbuf();
    return parse(text.str(), file.string(), file.has_parent_path() ? file.parent_path() : std::filesystem::path("."));
}

JsonValue JsonDocument::root() const { return JsonValue(root_.get(), &root_->tree, ""); }
std::string JsonDocument::canonical() const { return root_->tree.dump(-1, ' ', false, json::error_handler_t::replace); }

void JsonDocument::override_value(const std::string& path, const std::string& json_text, const std::string& origin)
{
    std::string pointer = path;
    if (pointer.empty() || pointer[0] != '/') {
        std::replace(pointer.begin(), pointer.end(), '.', '/');
        pointer = "/" + pointer;
    }
    // A bare word is a text: -D integrator.kind=ept.
    json value = json::parse(json_text, nullptr, false);
    if (value.is_discarded()) value = json_text;
    try {
        const json::json_pointer place(pointer);
        if (!place.empty() && place.back() == "-") {
            json& list = root_->tree[place.parent_pointer()];
            list.push_back(value);
            pointer = place.parent_pointer().to_string() + "/" + std::to_string(list.size() - 1);
        } else {
            root_->tree[place] = value;
        }
        if (!origin.empty()) root_->origins[pointer] = origin;
    } catch (const json::exception&) {
        throw InputError(origin.empty() ? "-D " + path : origin, "a path that leads nowhere",
                         "a path into the scene such as camera.fov");
    }
}

} // namespace scree
