#include "mixtures/type_table.h"

#include "base/byte_source.h"
#include "base/error.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <map>

namespace scree {

namespace {

std::string read_all(const std::filesystem::path& path)
{
    ByteSource source(path);
    std::string text;
    constexpr size_t chunk = size_t{1} << 24;
    for (size_t got = chunk; got == chunk;) {
        const size_t before = text.size();
        text.resize(before + chunk);
        got = source.read(text.data() + before, chunk);
        text.resize(before + got);
    }
    if (source.truncated()) throw InputError(path.string(), "packed data that end early", "a whole file");
    return text;
}

/// The C library's memchr searches sixteen bytes or more at a time; std::find does not.
const char* find_byte(const char* from, const char* end, char byte)
{
    const void* found = from < end ? std::memchr(from, byte, static_cast<size_t>(end - from)) : nullptr;
    return found ? static_cast<const char*>(found) : end;
}

std::string_view trimmed(std::string_view field)
{
    while (!field.empty() && (field.front() == ' ' || field.front() == '"')) field.remove_prefix(1);
    while (!field.empty() && (field.back() == ' ' || field.back() == '"' || field.back() == '\r'))
        field.remove_suffix(1);
    return field;
}

/// Numbers the different words of a column; words seen before are mostly found without a search.
class Words {
public:
    Words(std::vector<std::string>& words, const std::string& place) : words_(words), place_(place) {}

    uint16_t code(std::string_view word, uint64_t line)
    {
        const auto byte = [](char c) { return static_cast<unsigned char>(c); };
        const size_t slot = (byte(word.front()) * 31u + byte(word.back()) + word.size() * 7u) & 255;
        Met& met = met_[slot];
        if (met.word == word) return met.code;
        const auto number = to_int64(word);
        const std::string name = number ? std::to_string(*number) : std::string(word);
        const auto [entry, fresh] = codes_.try_emplace(name, static_cast<uint16_t>(words_.size()));
        if (fresh) {
            if (words_.size() == 65535)
                throw InputError(fmt::format("{}:{}", place_, line), "more than 65535 different types",
                                 "a column of types");
            words_.push_back(name);
        }
        met = {std::string(word), entry->second};
        return entry->second;
    }

private:
    struct Met {
        std::string word;
        uint16_t code = 0;
    };
    std::vector<std::string>& words_;
    const std::string& place_;
    std::array<Met, 256> met_;
    std::map<std::string, uint16_t> codes_;
};

struct Columns {
    char separator = ',';
    size_t type = 0, id = 0;
    bool has_id = false;
};

Columns find_columns(std::string_view line, const std::string& type, const std::string& id, const std::string& place)
{
    Columns columns;
    if (line.find(',') == std::string_view::npos)
        columns.separator = line.find(';') != std::string_view::npos    ? ';'
                            : line.find('\t') != std::string_view::npos ? '\t'
                                                                        : ',';
    std::vector<std::string> names;
    for (size_t begin = 0; begin <= line.size();) {
        const size_t end = std::min(line.find(columns.separator, begin), line.size());
        names.emplace_back(trimmed(line.substr(begin, end - begin)));
        begin = end + 1;
    }
    const auto find = [&](const std::string& name) {
        return static_cast<size_t>(std::ranges::find(names, name) - names.begin());
    };
    columns.type = find(type);
    if (columns.type == names.size()) {
        const std::string nearest = did_you_mean(type, names);
        throw InputError(place + ":1", "no column '" + type + "' among " + in_quotes(line),
                         "a first line of column names such as id,type",
                         nearest.empty() ? "\"column\" says which one holds the types" : nearest.substr(2));
    }
    columns.id = find(id);
    columns.has_id = columns.id < names.size();
    return columns;
}

TypeTable read_csv_types(const std::filesystem::path& path, const std::string& type, const std::string& id)
{
    const std::string place = path.string(), text = read_all(path);
    const char *at = text.data(), *const end = at + text.size();
    const auto line_end = [&] { return find_byte(at, end, '\n'); };
    if (text.starts_with("\xef\xbb\xbf")) at += 3; // the byte order mark of spreadsheets
    const char* stop = line_end();
    const Columns columns = find_columns(trimmed({at, static_cast<size_t>(stop - at)}), type, id, place);
    const size_t last = columns.has_id ? std::max(columns.type, columns.id) : columns.type;

    TypeTable table;
    Words words(table.words, place);
    const size_t guess = text.size() / static_cast<size_t>(stop - text.data() + 1) + 16;
    table.code.reserve(guess);
    if (columns.has_id) table.ids.reserve(guess);
    uint64_t line = 1;
    while (stop < end) {
        at = stop + 1;
        stop = line_end();
        ++line;
        const auto fail = [&](const std::string& found, const std::string& expected) {
            throw InputError(fmt::format("{}:{}", place, line), found, expected);
        };
        if (stop - at == 0 || (stop - at == 1 && *at == '\r')) continue;
        size_t column = 0;
        for (const char* field = at; column <= last; ++column) {
            if (field > stop)
                fail(in_quotes({at, static_cast<size_t>(stop - at)}), fmt::format("at least {} fields", last + 1));
            const char* const next = find_byte(field, stop, columns.separator);
            if (column == columns.type) {
                const std::string_view word = trimmed({field, static_cast<size_t>(next - field)});
                if (word.empty()) fail("no type", "a type number or a grain type");
                table.code.push_back(words.code(word, line));
            }
            if (column == columns.id && columns.has_id) {
                const std::string_view word = trimmed({field, static_cast<size_t>(next - field)});
                uint64_t value = 0;
                const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
                if (error != std::errc() || rest != word.data() + word.size())
                    fail(in_quotes(word), "the id of a sphere");
                table.ids.push_back(value);
            }
            field = next + 1;
        }
    }
    return table;
}

constexpr uint16_t no_code = 0xffff;

[[noreturn]] void fail_missing(const std::string& place, uint64_t id)
{
    throw InputError(place, fmt::format("no row for the sphere with id {}", id), "a type for every sphere of the dump");
}

/// Codes by id: an array indexed by id if the ids are close together, otherwise a list sorted by id.
class CodesById {
public:
    CodesById(const TypeTable& table, const std::string& place)
    {
        const auto [lo, hi] = std::ranges::minmax(table.ids);
        lo_ = lo;
        const auto twice = [&](uint64_t id) {
            throw InputError(place, fmt::format("id {} twice", id), "every id once");
        };
        if (hi - lo < 4 * table.ids.size() + 1024) {
            straight_.assign(hi - lo + 1, no_code);
            for (size_t i = 0; i < table.ids.size(); ++i) {
                uint16_t& code = straight_[table.ids[i] - lo];
                if (code != no_code) twice(table.ids[i]);
                code = table.code[i];
            }
            return;
        }
        sorted_.reserve(table.ids.size());
        for (size_t i = 0; i < table.ids.size(); ++i) sorted_.emplace_back(table.ids[i], table.code[i]);
        std::ranges::sort(sorted_);
        for (size_t i = 1; i < sorted_.size(); ++i)
            if (sorted_[i].first == sorted_[i - 1].first) twice(sorted_[i].first);
    }

    uint16_t find(uint64_t id) const
    {
        if (sorted_.empty()) return id >= lo_ && id - lo_ < straight_.size() ? straight_[id - lo_] : no_code;
        const auto it = std::ranges::lower_bound(sorted_, id, {}, &std::pair<uint64_t, uint16_t>::first);
        return it != sorted_.end() && it->first == id ? it->second : no_code;
    }

private:
    uint64_t lo_ = 0;
    std::vector<uint16_t> straight_;
    std::vector<std::pair<uint64_t, uint16_t>> sorted_;
};

} // namespace

TypeTable read_type_table(const std::filesystem::path& path, const std::string& type, const std::string& id)
{
    return lower_case(path.extension().string()) == ".vdb" ? read_vdb_types(path, type, id)
                                                           : read_csv_types(path, type, id);
}

std::unique_ptr<ExplicitMixture> mixture_from_table(const TypeTable& table, const std::vector<uint32_t>& type_of_word,
                                                    const ParticleFrame& frame, const std::string& place)
{
    if (table.ids.empty() && table.code.size() != frame.size()) {
        throw InputError(place, fmt::format("{} rows without ids", table.code.size()),
                         fmt::format("as many rows as spheres, {}", frame.size()), "give the table a column of ids");
    }
    const uint32_t highest = type_of_word.empty() ? 0 : std::ranges::max(type_of_word);
    const auto fill = [&](auto& types) {
        types.resize(frame.size());
        const auto as = [&](uint16_t code) {
            return static_cast<typename std::decay_t<decltype(types)>::value_type>(type_of_word[code]);
        };
        if (table.ids.empty()) {
            for (size_t i = 0; i < types.size(); ++i) types[i] = as(table.code[i]);
        } else {
            const CodesById codes(table, place);
            for (size_t i = 0; i < types.size(); ++i) {
                const uint16_t code = codes.find(frame.id[i]);
                if (code == no_code) fail_missing(place, frame.id[i]);
                types[i] = as(code);
            }
        }
    };
    if (highest > 0xff) {
        std::vector<uint32_t> types;
        fill(types);
        return std::make_unique<ExplicitMixture>(types);
    }
    std::vector<uint8_t> types;
    fill(types);
    return std::make_unique<ExplicitMixture>(std::move(types));
}

} // namespace scree
