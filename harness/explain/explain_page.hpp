#pragma once
// A page that shows an explanation in a browser, without network access.

#include <string>

#include <nlohmann/json.hpp>

namespace beambench::explain {

/// Returns a self-contained page with the data returned by `explain`. Throws InputError if this
/// build lacks three.js.
std::string explain_page(const nlohmann::json& explanation);

}  // namespace beambench::explain
