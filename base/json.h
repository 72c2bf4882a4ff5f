#pragma once

#include "base/enum_names.h"
#include "base/error.h"

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>
#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scree {

class JsonObject;

/// A value inside a JsonDocument together with its place, so that every error message can name the place.
///
/// A view: valid while the document lives. The typed getters throw InputError naming file, JSON path, found, expected.
class JsonValue {
public:
    bool is_number() const;
    bool is_string() const;
    bool is_array() const;
    bool is_object() const;

    double number(double lo = -std::numeric_limits<double>::infinity(),
                  double hi = std::numeric_limits<double>::infinity()) const;
    int64_t integer(int64_t lo, int64_t hi) const;
    bool boolean() const;
    std::string string() const;
    /// The index in `options` of this value, a string.
    size_t choice(const std::vector<std::string>& options) const;
    template <class E>
    E choice(const EnumNames<E>& names) const
    {
        choice(names.words());
        return *names.find(string());
    }
    Imath::V3d vec3() const;
    /// Three numbers in lo..hi, or one for all three.
    Imath::Color3<double> rgb(double lo, double hi) const;
    std::vector<JsonValue> array(size_t min_size = 0, size_t max_size = std::numeric_limits<size_t>::max()) const;
    JsonObject object() const;

    /// The file and JSON path, e.g. "scene.json: /grains/types/glass".
    std::string place() const;
    /// The folder from which relative paths start.
    const std::filesystem::path& folder() const;
    /// `string()` as a path; a relative path starts from `folder()`.
    std::filesystem::path path() const;
    /// The value as compact text, shortened for messages.
    std::string text() const;
    [[noreturn]] void fail(const std::string& expected, const std::string& hint = "") const;

private:
    friend class JsonDocument;
    friend class JsonObject;
    struct Root;
    JsonValue(const Root* root, const nlohmann::json* value, std::string path)
        : root_(root), value_(value), path_(std::move(path))
    {
    }
    const Root* root_;
    const nlohmann::json* value_;
    std::string path_;
};

/// An object being read: remembers which keys were asked for, so that `done` can refuse the others.
class JsonObject {
public:
    std::optional<JsonValue> find(const std::string& key);
    /// Throws when the key is missing.
    JsonValue require(const std::string& key);
    /// All keys, sorted; all of them count as asked for. For objects whose keys are names.
    std::vector<std::string> take_keys();
    const JsonValue& value() const { return value_; }
    /// Throws InputError for the first key that nobody asked for; suggests the nearest key that was asked for.
    void done() const;

private:
    friend class JsonValue;
    explicit JsonObject(JsonValue value) : value_(std::move(value)) {}
    JsonValue value_;
    std::vector<std::string> known_;
};

/// A parsed JSON text (comments allowed).
class JsonDocument {
public:
    /// Throws InputError with line and column when the text is not JSON.
    static JsonDocument load(const std::filesystem::path& file);
    static JsonDocument parse(const std::string& text, const std::string& name, const std::filesystem::path& folder);

    JsonValue root() const;
    /// The document as compact JSON with sorted keys; layout and comments make no difference.
    std::string canonical() const;
    /// Replaces (or adds) the value at a path such as "camera.fov" or "/camera/fov"; "-" is the place after a list's
    /// last.
    ///
    /// origin: where the value comes from, which complaints about it then name; empty: the file.
    void override_value(const std::string& path, const std::string& json_text, const std::string& origin = "");

    ~JsonDocument();
    JsonDocument(JsonDocument&&) noexcept;

private:
    JsonDocument();
    std::unique_ptr<JsonValue::Root> root_;
};

} // namespace scree
