#include "scenes/base/printable.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <system_error>

#include <fmt/format.h>

namespace beambench {
namespace {

constexpr std::size_t kLongestToken = 80;
constexpr std::size_t kLongestMessage = 4000;
constexpr std::size_t kMessageEnd = 1500;  // kept from the end if the middle is omitted
constexpr std::string_view kLeftOut = "...";

struct Character {
  std::size_t bytes;   ///< 1 for a byte that is not UTF-8
  std::uint32_t code;  ///< kInvalid for such a byte
};
constexpr std::uint32_t kInvalid = 0xFFFFFFFFU;

std::uint32_t byte_at(std::string_view text, std::size_t i) {
  return static_cast<unsigned char>(text[i]);
}

bool is_continuation(std::string_view text, std::size_t i) {
  return i < text.size() && (byte_at(text, i) & 0xC0U) == 0x80U;
}

/// Returns the first character of a nonempty text (The Unicode Standard, table 3-7).
Character first_character(std::string_view text) {
  struct Form {
    std::uint32_t mask, lead, least;  // first byte's mask and value; lowest code of this length
  };
  constexpr std::array<Form, 4> kForms{{{0x80U, 0x00U, 0x0U},
                                        {0xE0U, 0xC0U, 0x80U},
                                        {0xF0U, 0xE0U, 0x800U},
                                        {0xF8U, 0xF0U, 0x10000U}}};
  const std::uint32_t lead = byte_at(text, 0);
  for (std::size_t more = 0; more < kForms.size(); ++more) {
    const Form& form = kForms[more];
    if ((lead & form.mask) != form.lead) continue;
    std::uint32_t code = lead & ~form.mask;
    for (std::size_t i = 1; i <= more; ++i) {
      if (!is_continuation(text, i)) return {1, kInvalid};
      code = (code << 6U) | (byte_at(text, i) & 0x3FU);
    }
    const bool is_surrogate = code >= 0xD800U && code <= 0xDFFFU;
    if (code < form.least || code > 0x10FFFFU || is_surrogate) return {1, kInvalid};
    return {more + 1, code};
  }
  return {1, kInvalid};
}

bool is_shown(std::uint32_t code) {
  const auto between = [&](std::uint32_t first, std::uint32_t last) {
    return code >= first && code <= last;
  };
  const bool is_control = code < 0x20U || between(0x7FU, 0x9FU);
  const bool is_separator = between(0x2028U, 0x2029U);
  const bool is_direction = code == 0x061CU || between(0x200EU, 0x200FU) ||
                            between(0x202AU, 0x202EU) || between(0x2066U, 0x2069U);
  return code != kInvalid && code != 0xFEFFU && !is_control && !is_separator && !is_direction;
}

void append_escaped(std::string& text, std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    text += fmt::format("\\x{:02x}", byte_at(bytes, i));
  }
}

/// Returns a position at or shortly before `at` where the text can be cut between two characters.
std::size_t cut_near(std::string_view text, std::size_t at) {
  constexpr std::size_t kLongestCharacter = 4;
  for (std::size_t back = 0; back < std::min(at, kLongestCharacter); ++back) {
    if (!is_continuation(text, at - back)) return at - back;
  }
  return at;
}

/// Reads the byte whose escape, such as `\x1b`, begins at `text[at]`.
bool read_escaped(std::string_view text, std::size_t at, char& byte) {
  if (text.size() < at + 4 || text[at + 1] != 'x') return false;
  unsigned int value = 0;
  const char* digits = text.data() + at + 2;
  const auto [stop, error] = std::from_chars(digits, digits + 2, value, 16);
  if (error != std::errc() || stop != digits + 2) return false;
  byte = static_cast<char>(value);
  return true;
}

}  // namespace

std::string printable(std::string_view bytes) {
  std::string text;
  text.reserve(bytes.size());
  while (!bytes.empty()) {
    const Character next = first_character(bytes);
    const std::string_view own = bytes.substr(0, next.bytes);
    if (is_shown(next.code)) {
      text += own;
    } else {
      append_escaped(text, own);
    }
    bytes.remove_prefix(next.bytes);
  }
  return text;
}

std::string excerpt(std::string_view token) {
  if (token.size() <= kLongestToken) return printable(token);
  return printable(token.substr(0, cut_near(token, kLongestToken))) + std::string(kLeftOut);
}

std::string message_line(std::string_view message) {
  std::string line(message);
  if (message.size() > kLongestMessage) {
    const std::size_t begin = cut_near(message, kLongestMessage - kMessageEnd);
    const std::size_t end = cut_near(message, message.size() - kMessageEnd);
    line = fmt::format("{} {} {}", message.substr(0, begin), kLeftOut, message.substr(end));
  }
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  line.erase(line.find_last_not_of(' ') + 1);
  return printable(line);
}

std::string name_of_path(std::string_view path) {
  std::string doubled;
  for (const char c : path) doubled += c == '\\' ? std::string("\\\\") : std::string(1, c);
  return printable(doubled);
}

std::string path_of_name(std::string_view name) {
  std::string path;
  for (std::size_t i = 0; i < name.size(); ++i) {
    char byte = name[i];
    if (byte == '\\' && read_escaped(name, i, byte)) {
      i += 3;
    } else if (byte == '\\' && i + 1 < name.size() && name[i + 1] == '\\') {
      ++i;
    }
    path += byte;
  }
  return path;
}

bool is_utf8(std::string_view bytes) {
  while (!bytes.empty()) {
    const Character next = first_character(bytes);
    if (next.code == kInvalid) return false;
    bytes.remove_prefix(next.bytes);
  }
  return true;
}

}  // namespace beambench
