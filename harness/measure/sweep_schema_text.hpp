#pragma once
// sweep.schema.json, embedded in the program.

#include <string_view>

namespace beambench::measure {

/// Returns the text of sweep.schema.json.
std::string_view sweep_schema_text();

}  // namespace beambench::measure
