#include "render/app/medium_command.h"

#include "base/json.h"
#include "render/app/medium_report.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace scree {

void add_medium_option(CLI::App& app)
{
    CLI::App* info = app.get_subcommand("info");
    auto scenes = std::make_shared<std::vector<std::string>>();
    CLI::Option* option = info->add_option(
        "--medium", *scenes, "Scenes: describe their media, and the medium that represents their grains from afar");
    CLI::Option* files = info->get_option("FILE");
    files->required(false);
    info->parse_complete_callback([=] { // before the files, if there are any, are described
        if (!*option && files->empty()) throw CLI::RequiredError("FILE or --medium SCENE");
        const bool as_json = info->get_option("--json")->as<bool>();
        const auto frame = info->get_option("--frame")->as<size_t>();
        for (const std::string& file : *scenes) {
            const JsonDocument document = JsonDocument::load(file);
            const nlohmann::json description = describe_media(read_scene(document, file), frame, {});
            if (as_json)
                fmt::print("{}\n", description.dump());
            else
                fmt::print("{}", text_of_media(description));
        }
    });
}

} // namespace scree
