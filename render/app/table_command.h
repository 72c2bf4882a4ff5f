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

// Common parts of the commands that print a table of grains and draw a figure.

struct TableOutputs {
    std::string figure, size, json; ///< names of files, or empty; size: WIDTHxHEIGHT of the figure
    int threads = 0; ///< 0: all cores
    bool quiet = false;

    bool prints_table() const { return json != "-"; }
};

/// Adds --threads and --quiet.
void add_run_options(CLI::App& command, TableOutputs& outputs);

/// Throws InputError if an output file cannot be written; called before the work.
void check_outputs(const TableOutputs& outputs);

/// Does the command's work on `threads` threads (0: all cores); ends the program with status 130 if it is cancelled.
void run_command(int threads, const std::function<void()>& work);

/// Prints to standard output, at once.
void print_line(const std::string& line);
/// Writes to the file outputs.json, or to standard output if that is "-"; does nothing if it is empty.
void write_json(const TableOutputs& outputs, const std::function<std::string()>& json);
/// The text before progress: the name, and "(i of count)" if there is more than one.
std::string progress_prefix(const std::string& name, size_t i, size_t count);

/// Makes the bodies of a command's grains when they are asked for.
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
