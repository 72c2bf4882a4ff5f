#pragma once

#include "render/embree/embree_device.h"
#include "render/gsdf/gsdf_subject.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace scree {

// What the commands that print a table of grains, and draw a figure, have in common.

struct TableOutputs {
    std::string figure, size, json; ///< names of files, or empty; size: WIDTHxHEIGHT of the figure
    int threads = 0; ///< 0: all cores
    bool quiet = false;

    bool prints_table() const { return json != "-"; }
};

/// Adds --threads and --quiet.
void add_run_options(CLI::App& command, TableOutputs& outputs);

/// Throws InputError where a file cannot be written: before the work.
void check_outputs(const TableOutputs& outputs);

/// Does the command's work on so many threads; ends the program with status 130 where it was cancelled.
void run_command(int threads, const std::function<void()>& work);

/// To standard output, at once.
void print_line(const std::string& line);
/// To the file, or to standard output where it is "-"; nothing where it has no name.
void write_json(const TableOutputs& outputs, const std::function<std::string()>& json);
/// What progress is of: the name, and which of how many.
std::string progress_prefix(const std::string& name, size_t i, size_t count);

/// The bodies of a command's grains, as they are asked for.
class SubjectBodies {
public:
    /// place: the command, for messages.
    explicit SubjectBodies(std::string place) : place_(std::move(place)) {}
    /// Null for a sphere. Throws InputError.
    std::shared_ptr<const Exemplar> body(const GsdfSubject& subject);

private:
    std::string place_;
    std::optional<EmbreeDevice> device_;
};

} // namespace scree
