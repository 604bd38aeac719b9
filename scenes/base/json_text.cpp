#include "scenes/base/json_text.hpp"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/base/files.hpp"
#include "scenes/base/printable.hpp"

namespace beambench {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 64;

/// Returns whether a comma directly precedes the end of a list or object at that position.
bool comma_is_last(std::string_view text, std::size_t at) {
  if (at >= text.size() || (text[at] != ']' && text[at] != '}')) return false;
  const std::size_t before = text.substr(0, at).find_last_not_of(" \t\r\n");
  return before != std::string_view::npos && text[before] == ',';
}

/// Returns nlohmann's message without its prefix and position.
std::string_view plain_message(std::string_view what) {
  const std::size_t column = what.find("column ");
  const std::size_t start = column == std::string_view::npos ? column : what.find(": ", column);
  return start == std::string_view::npos ? what : what.substr(start + 2);
}

/// Reads a text without storing anything. Refuses invalid JSON, deep nesting, and duplicate keys in
/// one object, since nlohmann would silently keep only the last one's value.
class Checks : public nlohmann::json_sax<json> {
 public:
  Checks(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  bool null() override { return true; }
  bool boolean(bool /*value*/) override { return true; }
  bool number_integer(json::number_integer_t /*value*/) override { return true; }
  bool number_unsigned(json::number_unsigned_t /*value*/) override { return true; }
  bool number_float(json::number_float_t /*value*/, const std::string& /*text*/) override {
    return true;
  }
  bool string(std::string& /*value*/) override { return true; }
  bool binary(json::binary_t& /*value*/) override { return true; }

  bool start_object(std::size_t /*elements*/) override {
    keys_.emplace_back();
    return enter();
  }
  bool key(std::string& name) override {
    if (keys_.back().insert(name).second) return true;
    throw InputError(fmt::format("{}: the key {} is given twice in one object; keep one of them",
                                 file_, excerpt(json_text(json(name), -1))));
  }
  bool end_object() override {
    keys_.pop_back();
    return leave();
  }
  bool start_array(std::size_t /*elements*/) override { return enter(); }
  bool end_array() override { return leave(); }

  bool parse_error(std::size_t position, const std::string& token,
                   const json::exception& error) override {
    const std::size_t at = std::min(position > 0 ? position - 1 : 0, text_.size());
    const std::string_view before = text_.substr(0, at);
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t line_start = before.rfind('\n');
    const std::size_t column = line_start == std::string_view::npos ? at + 1 : at - line_start;
    throw InputError(fmt::format("{}:{}:{}: {}", file_, line, column, problem(at, token, error)));
  }

 private:
  bool enter() {
    if (++depth_ <= kMaxDepth) return true;
    throw InputError(
        fmt::format("{}: lists and objects nest more than {} levels deep; write it "
                    "flatter",
                    file_, kMaxDepth));
  }
  bool leave() {
    --depth_;
    return true;
  }

  std::string problem(std::size_t at, const std::string& token,
                      const json::exception& error) const {
    constexpr int kNumberOverflow = 406;  // nlohmann's number for this exception
    if (error.id == kNumberOverflow) {
      return fmt::format("the number {} is too large; write one up to 1e308", excerpt(token));
    }
    if (comma_is_last(text_, at)) {
      return fmt::format(
          "not JSON: there is a comma before this '{}', after the last element; remove the comma",
          text_[at]);
    }
    return fmt::format("not JSON: {}", plain_message(error.what()));
  }

  std::string_view text_;
  std::string file_;
  int depth_ = 0;
  std::vector<std::set<std::string>> keys_{};  // keys of the open objects
};

template <class Json>
std::string text_of(const Json& document, int indent) {
  return document.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

template <class Json>
Json parse_json(std::string_view text, const std::string& file) {
  Checks checks(text, file);
  json::sax_parse(text, &checks);
  return Json::parse(text);
}

template <class Json>
Json read_json_file(const std::filesystem::path& path) {
  return parse_json<Json>(read_text_input(path, kLargestDocument), path.string());
}

template nlohmann::json parse_json(std::string_view, const std::string&);
template nlohmann::ordered_json parse_json(std::string_view, const std::string&);
template nlohmann::json read_json_file(const std::filesystem::path&);
template nlohmann::ordered_json read_json_file(const std::filesystem::path&);

std::string json_text(const nlohmann::json& document, int indent) {
  return text_of(document, indent);
}
std::string json_text(const nlohmann::ordered_json& document, int indent) {
  return text_of(document, indent);
}

}  // namespace beambench
