#pragma once
// Values of a JSON document written by a person. Error messages state the place of the value.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/base/error.hpp"

namespace beambench::measure {

/// A value in a JSON document whose form has been checked (sweep_schema.hpp), and its place, which
/// messages state as a JSON pointer (RFC 6901): `file: /structures/1: ...`.
class JsonNode {
 public:
  /// The whole document. It must outlive the node and all nodes taken from it.
  JsonNode(const nlohmann::json& document, std::string file);

  const nlohmann::json& value() const { return *value_; }
  /// Returns `file: /structures/1`, the beginning of messages.
  std::string place() const;
  [[noreturn]] void fail(std::string_view message) const;
  /// Runs `work`; if it throws an InputError, adds the place at the beginning of its message.
  template <class Work>
  std::invoke_result_t<Work> checked(Work&& work) const {
    try {
      return std::invoke(work);
    } catch (const InputError& error) {
      fail(error.what());
    }
  }

  /// Returns a member of an object.
  std::optional<JsonNode> find(std::string_view key) const;
  /// Returns all members of an object, by key.
  std::vector<std::pair<std::string, JsonNode>> members() const;
  /// Returns the elements of an array.
  std::vector<JsonNode> elements() const;

  std::string text() const { return value_->get<std::string>(); }
  /// Returns a number, boolean or string as written after `key=` on a command line.
  std::string parameter_text() const;

 private:
  JsonNode(const nlohmann::json& value, std::string file, nlohmann::json::json_pointer pointer);

  const nlohmann::json* value_;
  std::string file_;
  nlohmann::json::json_pointer pointer_;
};

}  // namespace beambench::measure
