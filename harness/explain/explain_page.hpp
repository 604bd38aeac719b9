#pragma once
// A page that shows an explanation in a browser, without network.

#include <string>

#include <nlohmann/json.hpp>

namespace beambench::explain {

/// Returns a self-contained page with data as `explain` returns it. Throws InputError if this build
/// has no three.js.
std::string explain_page(const nlohmann::json& explanation);

}  // namespace beambench::explain
