#include "harness/cli/commands.hpp"

namespace beambench::cli {

std::vector<AddCommand*> thesis_commands() {
  return {add_sampling_command, add_census_command, add_mirrors_command};
}

}  // namespace beambench::cli
