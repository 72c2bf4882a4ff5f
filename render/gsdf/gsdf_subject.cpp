#include "render/gsdf/gsdf_subject.h"

#include "base/error.h"
#include "base/text.h"

#include <fmt/format.h>

namespace scree {

namespace {

const std::vector<std::string> kinds{"lambert", "dielectric", "conductor"};
constexpr double largest_index = 1000; // of a metal, with room

[[noreturn]] void fail_on_name(const std::string& word, const std::string& place)
{
    std::vector<std::string> names{"all", "sphere"};
    for (const LibraryGrain& grain : grain_library()) names.push_back(grain.name);
    const std::string nearest = did_you_mean(word, names);
    throw InputError(place, in_quotes(word), "a mesh file (.obj, .ply, .stl, .off) or one of: " + join_words(names),
                     nearest.empty() ? "" : nearest.substr(2));
}

Color rgb(const std::string& text, const Color& absent, const std::string& option)
{
    if (text.empty()) return absent;
    std::vector<float> numbers;
    for (size_t from = 0, comma = 0; comma != std::string::npos; from = comma + 1) {
        comma = text.find(',', from);
        const auto number = to_double(std::string_view(text).substr(from, comma - from));
        if (!number || !(*number >= 0 && *number <= largest_index)) numbers.resize(3); // so that there are too many
        numbers.push_back(static_cast<float>(number.value_or(0)));
    }
    if (numbers.size() == 1) return Color(numbers[0]);
    if (numbers.size() != 3)
        throw InputError(option, in_quotes(text),
                         "a number of 0 or more, or three for red, green and blue, as in 0.2,0.9,1.1");
    return {numbers[0], numbers[1], numbers[2]};
}

void override_material(const SubjectOptions& options, Material& material, const std::string& name)
{
    if (options.material) {
        const auto kind = std::ranges::find(kinds, *options.material);
        if (kind == kinds.end())
            throw InputError("--material", in_quotes(*options.material), join_words(kinds),
                             did_you_mean(*options.material, kinds));
        const auto wanted = static_cast<MaterialKind>(kind - kinds.begin());
        if (wanted != material.kind) {
            material = Material{};
            material.kind = wanted;
        }
    }
    const auto needs = [&](bool given, const std::string& option, bool applies, const std::string& what) {
        if (given && !applies)
            throw InputError(option,
                             fmt::format("'{}', which is a {}", name, kinds[static_cast<size_t>(material.kind)]), what,
                             "--material changes the material");
    };
    const bool conductor = material.kind == MaterialKind::conductor;
    needs(options.ior.has_value(), "--ior", material.kind == MaterialKind::dielectric, "a dielectric");
    needs(options.roughness.has_value(), "--roughness", material.kind != MaterialKind::lambert,
          "a dielectric or a conductor");
    needs(!options.eta.empty(), "--eta", conductor, "a conductor");
    needs(!options.k.empty(), "--k", conductor, "a conductor");
    if (options.ior) material.ior = *options.ior;
    if (options.roughness) material.alpha = *options.roughness * *options.roughness;
    if (material.kind == MaterialKind::dielectric && material.ior == 1) material.alpha = 0; // nothing to be rough
    material.eta = rgb(options.eta, material.eta, "--eta");
    material.k = rgb(options.k, material.k, "--k");
}

GsdfSubject subject_of(const std::string& word, const std::string& place)
{
    GsdfSubject subject;
    subject.name = word;
    subject.material.kind = MaterialKind::dielectric;
    if (word == "sphere") return subject;
    if (const LibraryGrain* grain = find_library_grain(word)) {
        subject.shape.library = grain;
        subject.material = grain->material;
        return subject;
    }
    if (!is_mesh_file_name(word)) fail_on_name(word, place);
    subject.shape.mesh = word;
    return subject;
}

} // namespace

bool is_mesh_file_name(const std::string& word)
{
    const std::string extension = lower_case(std::filesystem::path(word).extension().string());
    return extension == ".obj" || extension == ".ply" || extension == ".stl" || extension == ".off" ||
           word.find('/') != std::string::npos;
}

std::vector<GsdfSubject> gsdf_subjects(const std::vector<std::string>& words, const SubjectOptions& options,
                                       const std::string& place)
{
    std::vector<GsdfSubject> subjects;
    for (const std::string& word : words) {
        if (word != "all") {
            subjects.push_back(subject_of(word, place));
            continue;
        }
        for (const LibraryGrain& grain : grain_library()) subjects.push_back(subject_of(grain.name, place));
    }
    bool of_library = false;
    for (GsdfSubject& subject : subjects) {
        override_material(options, subject.material, subject.name);
        if (!subject.shape.library) continue;
        of_library = true;
        if (options.triangles) subject.shape.options.triangles = *options.triangles;
        if (options.seed) subject.shape.options.seed = *options.seed;
    }
    if (!of_library && (options.triangles || options.seed)) {
        throw InputError(options.triangles ? "--triangles" : "--seed", "no grain of the library",
                         "a library grain, whose shape it changes", "a mesh file or 'sphere' is used unchanged");
    }
    return subjects;
}

} // namespace scree
