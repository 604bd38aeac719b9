#include "scenes/base/kernel_text.hpp"

#include <algorithm>
#include <charconv>

#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"

namespace beambench {
namespace {

// A host with many containers has several thousand mounts, each a line of 200 bytes.
constexpr std::uint64_t kLargestKernelText = std::uint64_t{16} << 20U;

}  // namespace

std::string kernel_text(const std::filesystem::path& path) {
  try {
    return read_input(path, kLargestKernelText);
  } catch (const InputError&) {
    return "";
  }
}

std::optional<std::uint64_t> number_at(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

std::optional<std::uint64_t> value_of(std::string_view text, std::string_view key) {
  for (std::size_t start = 0; start < text.size();) {
    if (text.substr(start).starts_with(key)) return number_at(text.substr(start + key.size()));
    start = std::min(text.find('\n', start), text.size() - 1) + 1;
  }
  return std::nullopt;
}

}  // namespace beambench
