#pragma once
// May a run go on where it was cut off?

#include <nlohmann/json.hpp>

#include "harness/bench/record/run_folder.hpp"

namespace beambench::bench {

/// Throws InputError when the run in `folder` was made with another configuration, by another
/// program or machine, with other plug-ins or with a scene that has changed since: its cells and
/// new ones would not compare. The reason is named.
void require_same_run(const RunFolder& folder, const nlohmann::json& config,
                      const nlohmann::ordered_json& manifest);

}  // namespace beambench::bench
