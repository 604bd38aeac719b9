#include "harness/explain/explain_page.hpp"

#include <string_view>

#include "harness/explain/viewer_text.hpp"
#include "scenes/base/error.hpp"

namespace beambench::explain {
namespace {

/// Replaces the mark, which must occur exactly once in the text.
void fill(std::string& text, std::string_view mark, std::string_view content) {
  text.replace(text.find(mark), mark.size(), content);
}

/// Returns JSON that is safe inside an HTML script element: names may contain "</script>".
std::string script_text(const nlohmann::json& data) {
  std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
    text.replace(at, 1, "\\u003c");
  }
  return text;
}

}  // namespace

std::string explain_page(const nlohmann::json& explanation) {
  if (three_text().empty()) {
    throw InputError(
        "this build of beambench has no three.js, which pages need; run scripts/viewer where npm's "
        "registry is reachable, and build again");
  }
  std::string page(page_text());
  // Fill in the data last, because a name in it may look like a mark.
  fill(page, "@STYLE@", style_text());
  fill(page, "@THREE@", three_text());
  fill(page, "@CONTROLS@", controls_text());
  fill(page, "@VIEWER@", viewer_text());
  fill(page, "@DATA@", script_text(explanation));
  return page;
}

}  // namespace beambench::explain
