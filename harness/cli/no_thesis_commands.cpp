// Replaces the commands of the thesis if they are not built (BEAMBENCH_THESIS=OFF).

#include "harness/cli/commands.hpp"

namespace beambench::cli {

std::vector<AddCommand*> thesis_commands() { return {}; }

}  // namespace beambench::cli
