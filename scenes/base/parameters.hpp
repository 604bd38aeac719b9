#pragma once
// Named, typed, documented parameters: `samet:max_level=6,max_objects=0`, `balls:n=4`.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace beambench {

/// A name with parameters as a user types it: `name` or `name:key=value,key=value`.
struct Spec {
  std::string name;
  std::vector<std::pair<std::string, std::string>> parameters;

  friend bool operator==(const Spec&, const Spec&) = default;
};

/// Parses a spec. Throws InputError if the text does not have that form or contains a key twice.
Spec parse_spec(std::string_view text);

/// Splits `a:x=1,y=2,b` into the specs `a:x=1,y=2` and `b`: a comma starts a new spec unless an `=`
/// follows before the next comma or colon. Throws like parse_spec.
std::vector<Spec> parse_spec_list(std::string_view text);

/// The declaration of a parameter of a structure or a generator; printed by `beambench list`.
struct ParameterInfo {
  enum class Type { kInteger, kIntegerOrAuto, kReal, kFlag, kChoice, kCells };

  std::string name;
  Type type;
  std::string default_value;
  double minimum = 0.0;  ///< for a number (including cells); inclusive, like `maximum`
  double maximum = 0.0;
  std::vector<std::string> choices;  ///< for a choice
  std::string description;           ///< one sentence, units included
  bool changes_hits = false;         ///< other values may cause wrong hits and are not self-tested
};

ParameterInfo integer_parameter(std::string name, std::int64_t default_value, std::int64_t minimum,
                                std::int64_t maximum, std::string description);
/// Declares a whole number or `auto`, with which the structure chooses.
ParameterInfo integer_or_auto_parameter(std::string name, std::int64_t default_value,
                                        std::int64_t minimum, std::int64_t maximum,
                                        std::string description);
ParameterInfo real_parameter(std::string name, double default_value, double minimum, double maximum,
                             std::string description);
ParameterInfo flag_parameter(std::string name, bool default_value, std::string description);
ParameterInfo choice_parameter(std::string name, std::string default_value,
                               std::vector<std::string> choices, std::string description);
/// Declares cells along each axis: `32`, `64x32x16`, or `auto`.
ParameterInfo cells_parameter(std::string name, std::string default_value, std::int64_t maximum,
                              std::string description);

/// The values of one owner's parameters, with defaults for those not given.
class Parameters {
 public:
  /// Checks every given value against `infos`. Throws an InputError that names `owner`, the
  /// parameter, the value, its valid range or choices and, for an unknown name, all valid names.
  Parameters(std::string owner, std::span<const ParameterInfo> infos,
             std::span<const std::pair<std::string, std::string>> given);

  /// Each of these functions throws std::logic_error if the owner did not declare a parameter of
  /// that name and type.
  std::int64_t integer(std::string_view name) const;
  /// Returns nothing for `auto`.
  std::optional<std::int64_t> integer_or_auto(std::string_view name) const;
  double real(std::string_view name) const;
  bool flag(std::string_view name) const;
  const std::string& choice(std::string_view name) const;
  /// Returns nothing for `auto`.
  std::optional<std::array<std::int32_t, 3>> cells(std::string_view name) const;

  /// Throws std::logic_error with the name of a parameter that was given but never read because its
  /// owner declares and ignores it.
  void require_given_were_read() const;

  /// Returns all parameters with their values in declared order, such as
  /// `max_level=6,max_objects=0`. Numbers are in their shortest exact form, so equal values print
  /// alike.
  std::string canonical() const;
  /// Returns owner and canonical parameters, `samet:max_level=6,max_objects=0`, or the bare owner.
  std::string label() const;
  /// Returns the same label with only non-default values: `samet:max_level=6`.
  std::string short_label() const;
  /// Returns name-value pairs as in canonical().
  std::vector<std::pair<std::string, std::string>> values() const;

 private:
  struct Value {
    ParameterInfo info;
    std::string text;
    double number = 0.0;
    bool given = false;
    mutable bool read = false;
  };
  const Value& find(std::string_view name, ParameterInfo::Type type) const;

  std::string owner_;
  std::vector<Value> values_;
};

}  // namespace beambench
