#include "packing/pack_command.h"

#include <CLI/CLI.hpp>

namespace scree {

void add_pack_report_command(CLI::App&)
{
}

} // namespace scree
