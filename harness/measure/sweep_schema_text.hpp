#pragma once
// sweep.schema.json, as the program holds it.

#include <string_view>

namespace beambench::measure {

/// Returns the text of sweep.schema.json.
std::string_view sweep_schema_text();

}  // namespace beambench::measure
