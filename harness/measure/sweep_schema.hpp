#pragma once
// The form of a sweep's file, as defined by sweep.schema.json.

#include <string>

#include <nlohmann/json.hpp>

namespace beambench::measure {

/// Requires that a document conforms to sweep.schema.json. Throws InputError with the first error
/// that valijson finds: `FILE: /structures/1/parameters: expected an object, found 3`, with the
/// value's JSON pointer (RFC 6901).
void require_sweep_form(const nlohmann::json& document, const std::string& file);

}  // namespace beambench::measure
