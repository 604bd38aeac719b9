#include "harness/bench/json_node.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/core/files.hpp"
#include "scenes/core/nearest_name.hpp"

namespace beambench::bench {
namespace {

using nlohmann::json;

/// Is a comma right before the end of a list or object there?
bool comma_is_last(std::string_view text, std::size_t at) {
  if (at >= text.size() || (text[at] != ']' && text[at] != '}')) return false;
  const std::size_t before = text.substr(0, at).find_last_not_of(" \t\r\n");
  return before != std::string_view::npos && text[before] == ',';
}

/// nlohmann's message without its own prefix and position.
std::string_view plain_message(std::string_view what) {
  const std::size_t column = what.find("column ");
  const std::size_t start = column == std::string_view::npos ? column : what.find(": ", column);
  return start == std::string_view::npos ? what : what.substr(start + 2);
}

[[noreturn]] void fail_malformed(const std::string& file, std::string_view text,
                                 const json::parse_error& error) {
  const std::size_t at = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
  const std::string_view before = text.substr(0, at);
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t line_start = before.rfind('\n');
  const std::size_t column = line_start == std::string_view::npos ? at + 1 : at - line_start;
  if (comma_is_last(text, at)) {
    throw InputError(fmt::format(
        "{}:{}:{}: not JSON: there is a comma before this '{}', after the last element; "
        "remove the comma",
        file, line, column, text[at]));
  }
  throw InputError(
      fmt::format("{}:{}:{}: not JSON: {}", file, line, column, plain_message(error.what())));
}

/// A parser callback that refuses a key given twice in one object, which nlohmann would let win.
class DuplicateKeys {
 public:
  explicit DuplicateKeys(std::string file) : file_(std::move(file)) {}

  bool operator()(int /*depth*/, json::parse_event_t event, const json& parsed) {
    if (event == json::parse_event_t::object_start) seen_.emplace_back();
    if (event == json::parse_event_t::object_end) seen_.pop_back();
    if (event == json::parse_event_t::key && !seen_.back().insert(parsed).second) {
      throw InputError(fmt::format("{}: the key {} is given twice in one object; keep one of them",
                                   file_, parsed.dump()));
    }
    return true;
  }

 private:
  std::string file_;
  std::vector<std::set<std::string>> seen_;
};

/// A value as a message shows it.
std::string shown(const json& value) {
  constexpr std::size_t kMaxLength = 40;
  if (value.is_object()) return "an object";
  if (value.is_array()) return value.empty() ? "an empty list" : "a list";
  const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  return text.size() <= kMaxLength ? text : text.substr(0, kMaxLength) + "...";
}

}  // namespace

json read_json_file(const std::filesystem::path& path) {
  const std::string text = read_input(path, kLargestDocument);
  try {
    return json::parse(text, DuplicateKeys(path.string()));
  } catch (const json::parse_error& error) {
    fail_malformed(path.string(), text, error);
  }
}

JsonNode::JsonNode(const json& document, std::string file)
    : JsonNode(document, std::move(file), json::json_pointer()) {}

JsonNode::JsonNode(const json& value, std::string file, json::json_pointer pointer)
    : value_(&value), file_(std::move(file)), pointer_(std::move(pointer)) {}

std::string JsonNode::place() const {
  return pointer_.empty() ? file_ : fmt::format("{}: {}", file_, pointer_.to_string());
}

void JsonNode::fail(std::string_view message) const {
  throw InputError(fmt::format("{}: {}", place(), message));
}

void JsonNode::fail_expecting(std::string_view expected) const {
  fail(fmt::format("expected {}, found {}", expected, shown(*value_)));
}

void JsonNode::require_object(std::initializer_list<std::string_view> known_keys) const {
  if (!value_->is_object()) fail_expecting("an object");
  const std::vector<std::string> known(known_keys.begin(), known_keys.end());
  for (const auto& [key, member] : members()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    member.fail(fmt::format("unknown key; {}expected one of {}", did_you_mean(key, known),
                            fmt::join(known, ", ")));
  }
}

std::optional<JsonNode> JsonNode::find(std::string_view key) const {
  const auto found = value_->find(std::string(key));
  if (found == value_->end()) return std::nullopt;
  return JsonNode(*found, file_, pointer_ / std::string(key));
}

JsonNode JsonNode::require(std::string_view key) const {
  if (auto member = find(key)) return *std::move(member);
  fail(fmt::format("the key '{}' is missing", key));
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::members() const {
  if (!value_->is_object()) fail_expecting("an object");
  std::vector<std::pair<std::string, JsonNode>> list;
  for (const auto& [key, value] : value_->items()) {
    list.emplace_back(key, JsonNode(value, file_, pointer_ / key));
  }
  return list;
}

std::vector<JsonNode> JsonNode::elements() const {
  if (!value_->is_array() || value_->empty()) fail_expecting("a list with at least one element");
  std::vector<JsonNode> list;
  for (std::size_t i = 0; i < value_->size(); ++i) {
    list.push_back(JsonNode((*value_)[i], file_, pointer_ / i));
  }
  return list;
}

std::string JsonNode::text() const {
  if (!value_->is_string()) fail_expecting("a string");
  return value_->get<std::string>();
}

std::int64_t JsonNode::integer(std::int64_t minimum, std::int64_t maximum) const {
  const std::string expected = fmt::format("a whole number from {} to {}", minimum, maximum);
  if (!value_->is_number_integer()) fail_expecting(expected);
  // A number beyond 2^63 - 1 is held unsigned and would wrap.
  const bool huge = value_->is_number_unsigned() && value_->get<std::uint64_t>() > INT64_MAX;
  const auto number = value_->get<std::int64_t>();
  if (huge || number < minimum || number > maximum) fail_expecting(expected);
  return number;
}

double JsonNode::number(double minimum, double maximum) const {
  const std::string expected = fmt::format("a number from {} to {}", minimum, maximum);
  if (!value_->is_number()) fail_expecting(expected);
  const auto number = value_->get<double>();
  if (!(number >= minimum && number <= maximum)) fail_expecting(expected);
  return number;
}

std::string JsonNode::parameter_text() const {
  if (value_->is_string()) return value_->get<std::string>();
  if (value_->is_number_float()) return fmt::format("{}", value_->get<double>());
  if (value_->is_number_integer() || value_->is_boolean()) return value_->dump();
  fail_expecting("a number, a string, true or false");
}

}  // namespace beambench::bench
