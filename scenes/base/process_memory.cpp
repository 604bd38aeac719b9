#include "scenes/base/process_memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <malloc.h>

#include "scenes/base/control_groups.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/kernel_text.hpp"

namespace beambench {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kKibi = 1024;

std::optional<std::uint64_t> status_bytes(std::string_view key) {
  const auto kibibytes = value_of(kernel_text("/proc/self/status"), key);
  return kibibytes ? std::optional(*kibibytes * kKibi) : std::nullopt;
}

std::uint64_t left_of(std::uint64_t limit, std::uint64_t used) {
  return limit > used ? limit - used : 0;
}

/// Returns the memory left to one control group. The group's file cache can be reclaimed and does
/// not count as used.
std::optional<std::uint64_t> left_of_group(const fs::path& folder, const char* limit_name,
                                           const char* used_name, const char* cached_name) {
  const auto limit = number_at(kernel_text(folder / limit_name));
  const auto used = number_at(kernel_text(folder / used_name));
  if (!limit || !used) return std::nullopt;  // `max`: there is no limit
  const auto cached = value_of(kernel_text(folder / "memory.stat"), cached_name).value_or(0);
  return left_of(*limit, left_of(*used, cached));
}

/// Returns the number of bytes in BEAMBENCH_MEMORY, or nothing if the variable is not set.
std::optional<std::uint64_t> own_limit() {
  const char* const set = std::getenv("BEAMBENCH_MEMORY");
  if (set == nullptr || *set == '\0') return std::nullopt;
  const std::string_view text = set;
  constexpr std::string_view kUnits = "KMGT";
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const std::string_view unit = text.substr(digits);
  const std::size_t power = unit.empty() ? 0 : kUnits.find(unit) + 1;
  const auto number = number_at(text.substr(0, digits));
  const bool is_known = unit.empty() || (unit.size() == 1 && power > 0);
  if (!number || digits > 12 || !is_known) {
    throw InputError(fmt::format(
        "BEAMBENCH_MEMORY is '{}', not a number of bytes; write it as 800M or 12G", text));
  }
  return *number << (10 * power);
}

void take_least(std::optional<std::uint64_t>& least, const std::optional<std::uint64_t>& other) {
  if (other) least = std::min(least.value_or(*other), *other);
}

}  // namespace

std::optional<std::uint64_t> available_memory(const fs::path& root) {
  if (const auto limit = own_limit()) {
    return left_of(*limit, status_bytes("VmRSS:").value_or(0));
  }
  std::optional<std::uint64_t> least;
  if (const auto kibibytes = value_of(kernel_text(root / "proc/meminfo"), "MemAvailable:")) {
    least = *kibibytes * kKibi;
  }
  const ControlGroups groups = control_groups("memory", root);
  for (const fs::path& folder : groups.version2) {
    take_least(least, left_of_group(folder, "memory.max", "memory.current", "inactive_file "));
  }
  for (const fs::path& folder : groups.version1) {
    take_least(least, left_of_group(folder, "memory.limit_in_bytes", "memory.usage_in_bytes",
                                    "total_inactive_file "));
  }
  return least;
}

std::optional<std::uint64_t> mapped_data_bytes() { return status_bytes("VmData:"); }

std::optional<std::uint64_t> peak_memory_growth(const std::function<void()>& work) {
#ifdef __GLIBC__
  ::malloc_trim(0);  // otherwise `work` could reuse freed memory unnoticed
#endif
  // `write_file` is not used, because this is a kernel switch. 5 resets the peak (proc(5)).
  std::ofstream("/proc/self/clear_refs") << "5" << std::flush;
  const auto before = status_bytes("VmRSS:");
  const auto peak_before = status_bytes("VmHWM:");
  work();
  const auto peak = status_bytes("VmHWM:");
  // A peak that was not reset may have been reached before this work.
  constexpr std::uint64_t kAgree = std::uint64_t{4} << 20U;
  if (!before || !peak_before || !peak || *peak_before > *before + kAgree) return std::nullopt;
  return left_of(*peak, *before);
}

}  // namespace beambench
