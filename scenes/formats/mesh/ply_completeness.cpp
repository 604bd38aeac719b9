#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "scenes/core/error.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"

namespace beambench::scenes::mesh {
namespace {

struct Property {
  std::size_t size = 0;        ///< of the value, or of each item of a list
  std::size_t count_size = 0;  ///< of a list's count; 0: not a list
};

struct Element {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  enum class Format { kText, kLittleEndian, kBigEndian };

  Format format = Format::kText;
  std::vector<Element> elements;
};

/// The next word of a line, which loses it; empty at the end.
std::string_view take_word(std::string_view& line) {
  constexpr std::string_view kBlanks = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

/// The next line, which the text loses; nothing at the end.
std::optional<std::string_view> take_line(std::string_view& text) {
  if (text.empty()) return std::nullopt;
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

std::size_t size_of_type(std::string_view name) {
  struct Type {
    std::string_view name;
    std::size_t size;
  };
  constexpr std::array<Type, 16> kTypes = {{{"char", 1},
                                            {"int8", 1},
                                            {"uchar", 1},
                                            {"uint8", 1},
                                            {"short", 2},
                                            {"int16", 2},
                                            {"ushort", 2},
                                            {"uint16", 2},
                                            {"int", 4},
                                            {"int32", 4},
                                            {"uint", 4},
                                            {"uint32", 4},
                                            {"float", 4},
                                            {"float32", 4},
                                            {"double", 8},
                                            {"float64", 8}}};
  const auto* const found = std::find_if(kTypes.begin(), kTypes.end(),
                                         [&](const Type& type) { return type.name == name; });
  return found == kTypes.end() ? 0 : found->size;
}

/// `property float x`, `property list uchar int vertex_indices`, without the first word.
std::optional<Property> parse_property(std::string_view line) {
  Property property;
  std::string_view type = take_word(line);
  if (type == "list") {
    property.count_size = size_of_type(take_word(line));
    if (property.count_size == 0) return std::nullopt;
    type = take_word(line);
  }
  property.size = size_of_type(type);
  if (property.size == 0) return std::nullopt;
  return property;
}

std::optional<Element> parse_element(std::string_view line) {
  Element element;
  element.name = take_word(line);
  const std::string_view count = take_word(line);
  const auto [end, error] =
      std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (error != std::errc() || count.empty()) return std::nullopt;
  return element;
}

std::optional<Header::Format> parse_format(std::string_view line) {
  const std::string_view word = take_word(line);
  if (word == "ascii") return Header::Format::kText;
  if (word == "binary_little_endian") return Header::Format::kLittleEndian;
  if (word == "binary_big_endian") return Header::Format::kBigEndian;
  return std::nullopt;
}

/// Takes the header off the text; nothing where it cannot be understood.
std::optional<Header> take_header(std::string_view& text) {
  Header header;
  while (auto line = take_line(text)) {
    const std::string_view word = take_word(*line);
    if (word == "end_header") return header;
    if (word == "format") {
      const auto format = parse_format(*line);
      if (!format) return std::nullopt;
      header.format = *format;
    } else if (word == "element") {
      auto element = parse_element(*line);
      if (!element) return std::nullopt;
      header.elements.push_back(std::move(*element));
    } else if (word == "property") {
      const auto property = parse_property(*line);
      if (!property || header.elements.empty()) return std::nullopt;
      header.elements.back().properties.push_back(*property);
    }
  }
  return std::nullopt;
}

/// Takes one element's line off the text; false where there is none.
bool take_text_row(std::string_view& text) {
  while (auto line = take_line(text)) {
    if (!take_word(*line).empty()) return true;
  }
  return false;
}

bool skip(std::string_view& bytes, std::uint64_t count) {
  if (bytes.size() < count) return false;
  bytes.remove_prefix(count);
  return true;
}

/// Takes one element's bytes off; false where they are not all there.
bool take_binary_row(std::string_view& bytes, const Element& element, Header::Format format) {
  for (const Property& property : element.properties) {
    std::uint64_t count = 1;
    if (property.count_size > 0) {
      if (bytes.size() < property.count_size) return false;
      count = 0;
      for (std::size_t i = 0; i < property.count_size; ++i) {
        const std::size_t at =
            format == Header::Format::kBigEndian ? i : property.count_size - 1 - i;
        count = count << 8U | static_cast<unsigned char>(bytes[at]);
      }
      bytes.remove_prefix(property.count_size);
      if (count > bytes.size()) return false;
    }
    if (!skip(bytes, count * property.size)) return false;
  }
  return true;
}

}  // namespace

void require_complete_ply(std::string_view bytes, const std::filesystem::path& path) {
  const auto header = take_header(bytes);
  if (!header) return;
  for (const Element& element : header->elements) {
    if (element.properties.empty() && element.count > 0 &&
        header->format != Header::Format::kText) {  // it has no bytes, however many there are
      throw InputError(
          fmt::format("{}: its header declares {} of the element '{}', but no property of it; "
                      "export it again",
                      path.string(), element.count, element.name));
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const bool there = header->format == Header::Format::kText
                             ? take_text_row(bytes)
                             : take_binary_row(bytes, element, header->format);
      if (there) continue;
      throw InputError(fmt::format(
          "{}: its header declares {} of the element '{}', but after {} the file ends: it is cut "
          "off, or its header is invalid; get it again",
          path.string(), element.count, element.name, i));
    }
  }
}

}  // namespace beambench::scenes::mesh
