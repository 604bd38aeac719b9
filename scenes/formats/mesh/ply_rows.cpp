#include "scenes/formats/mesh/ply_rows.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "scenes/base/decimal.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::scenes::mesh {
namespace {

template <typename Integer>
std::optional<double> integer_within(std::string_view word) {
  const auto number = integer_of(word);
  if (!number || *number < std::numeric_limits<Integer>::min() ||
      *number > std::numeric_limits<Integer>::max()) {
    return std::nullopt;
  }
  return static_cast<double>(*number);
}

/// Returns the value of a word of the type. It is the same as in a binary file, so that both files
/// result in the same mesh. A double represents every type exactly.
std::optional<double> ply_number(std::string_view word, PlyType type) {
  switch (type) {
    case PlyType::kInt8:
      return integer_within<std::int8_t>(word);
    case PlyType::kUint8:
      return integer_within<std::uint8_t>(word);
    case PlyType::kInt16:
      return integer_within<std::int16_t>(word);
    case PlyType::kUint16:
      return integer_within<std::uint16_t>(word);
    case PlyType::kInt32:
      return integer_within<std::int32_t>(word);
    case PlyType::kUint32:
      return integer_within<std::uint32_t>(word);
    case PlyType::kFloat32:
      return number_of<float>(word);
    case PlyType::kFloat64:
      return number_of<double>(word);
  }
  return std::nullopt;
}

std::string_view name_of(PlyType type) {
  constexpr std::array<std::string_view, 8> kNames = {"char", "uchar", "short", "ushort",
                                                      "int",  "uint",  "float", "double"};
  return kNames[static_cast<std::size_t>(type)];
}

}  // namespace

// Text

bool PlyTextRows::begin(const PlyElement& element, std::uint64_t row) {
  element_ = element.name;
  row_ = row;
  return lines_.next_with_words();
}

std::string_view PlyTextRows::word() {
  const std::string_view word = lines_.word();
  if (word.empty()) refuse("the line ends before the numbers that the header declares");
  return word;
}

double PlyTextRows::number(PlyType type) {
  const std::string_view text = word();
  const auto number = ply_number(text, type);
  if (!number) {
    refuse(fmt::format("'{}' is not a number of the type {}", excerpt(text), name_of(type)));
  }
  return *number;
}

void PlyTextRows::skip(PlyType, std::uint64_t count) {
  for (; count > 0; --count) word();
}

void PlyTextRows::end() {
  const std::string_view more = lines_.word();
  if (!more.empty()) {
    refuse(fmt::format("'{}' follows the numbers that the header declares", excerpt(more)));
  }
}

void PlyTextRows::finish() {
  if (!lines_.next_with_words()) return;
  lines_.refuse(
      fmt::format("'{}' follows the last row that the header declares", excerpt(lines_.word())));
}

std::size_t PlyTextRows::at_most(std::size_t properties) const {
  return lines_.text_after().size() / (2 * properties) + 1;
}

void PlyTextRows::refuse(std::string_view why) const {
  lines_.refuse(fmt::format("{} {}: {}", excerpt(element_), row_, why));
}

// Binary

PlyBinaryRows::PlyBinaryRows(std::string_view bytes, std::string_view rest,
                             PlyHeader::Encoding encoding)
    : size_(bytes.size()),
      rest_(rest),
      swapped_((encoding == PlyHeader::Encoding::kBigEndian) !=
               (std::endian::native == std::endian::big)) {}

bool PlyBinaryRows::begin(const PlyElement& element, std::uint64_t row) {
  element_ = element.name;
  row_ = row;
  return !rest_.empty();
}

template <typename Number>
double PlyBinaryRows::take() {
  std::array<char, sizeof(Number)> bytes{};
  if (rest_.size() < bytes.size()) refuse("the file ends within it: it is cut off");
  std::memcpy(bytes.data(), rest_.data(), bytes.size());
  rest_.remove_prefix(bytes.size());
  if (swapped_) std::reverse(bytes.begin(), bytes.end());
  return static_cast<double>(std::bit_cast<Number>(bytes));
}

double PlyBinaryRows::number(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
      return take<std::int8_t>();
    case PlyType::kUint8:
      return take<std::uint8_t>();
    case PlyType::kInt16:
      return take<std::int16_t>();
    case PlyType::kUint16:
      return take<std::uint16_t>();
    case PlyType::kInt32:
      return take<std::int32_t>();
    case PlyType::kUint32:
      return take<std::uint32_t>();
    case PlyType::kFloat32:
      return take<float>();
    case PlyType::kFloat64:
      return take<double>();
  }
  return 0.0;
}

void PlyBinaryRows::skip(PlyType type, std::uint64_t count) {
  if (rest_.size() / size_of(type) < count) refuse("the file ends within it: it is cut off");
  rest_.remove_prefix(count * size_of(type));
}

void PlyBinaryRows::finish() {
  if (rest_.empty()) return;
  throw InputError(fmt::format(
      "byte {}: {} after the last row that the header declares; export "
      "it again",
      position(),
      rest_.size() == 1 ? "one byte follows" : fmt::format("{} bytes follow", rest_.size())));
}

void PlyBinaryRows::refuse(std::string_view why) const {
  throw InputError(
      fmt::format("byte {}: {} {}: {}; export it again", position(), excerpt(element_), row_, why));
}

}  // namespace beambench::scenes::mesh
