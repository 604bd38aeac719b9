#include "accel/embree/isa.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <map>
#include <mutex>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include "accel/core/instruction_set.hpp"
#include "accel/embree_api/device.hpp"
#include "scenes/base/error.hpp"

namespace beambench::accel::embree {
namespace {

/// One instruction set by its three names.
struct Isa {
  const char* parameter;  ///< value of isa_parameter
  const char* config;     ///< name in a device's configuration
  const char* printed;    ///< name that a verbose device prints
};
constexpr std::array<Isa, 3> kIsas{
    {{"avx512", "avx512", "AVX512"}, {"avx2", "avx2", "AVX2"}, {"sse4", "sse4.2", "SSE4.2"}}};

/// Redirects std::cout into a string during its lifetime.
class CaptureStandardOutput {
 public:
  CaptureStandardOutput() : before_(std::cout.rdbuf(captured_.rdbuf())) {}
  CaptureStandardOutput(const CaptureStandardOutput&) = delete;
  CaptureStandardOutput& operator=(const CaptureStandardOutput&) = delete;
  ~CaptureStandardOutput() { std::cout.rdbuf(before_); }

  std::string text() const { return captured_.str(); }

 private:
  std::ostringstream captured_;
  std::streambuf* before_;
};

/// Returns the words before `mark` on its line, without those up to a word ":".
std::vector<std::string> words_before(const std::string& text, std::string_view mark) {
  const std::size_t end = text.find(mark);
  if (end == std::string::npos) return {};
  const std::size_t newline = text.rfind('\n', end);
  std::istringstream line(text.substr(newline + 1, end - newline - 1));
  std::vector<std::string> words;
  for (std::string word; line >> word;) {
    if (word == ":") {
      words.clear();
    } else {
      words.push_back(word);
    }
  }
  return words;
}

/// Returns the best of our instruction sets that the machine supports, or nullptr if it supports
/// none.
const Isa* best_of_machine() {
  const auto found =
      std::ranges::find_if(kIsas, [](const Isa& isa) { return is_available(isa.parameter); });
  return found == kIsas.end() ? nullptr : &*found;
}

}  // namespace

std::string device_config(const std::string& isa, int threads) {
  const auto found = std::ranges::find(kIsas, isa, &Isa::parameter);
  const std::string config = fmt::format("threads={}", threads);
  return found == kIsas.end() ? config : fmt::format("{},isa={}", config, found->config);
}

std::string widest_target(const std::string& printed) {
  // "Targets : SSE ... AVX512 (supported)" and below "SSE2 ... AVX512 (compile time enabled)", both
  // ordered from the narrowest to the widest.
  const std::vector<std::string> supported = words_before(printed, "(supported)");
  std::string widest = "unknown";
  for (const std::string& target : words_before(printed, "(compile time enabled)")) {
    if (std::ranges::find(supported, target) != supported.end()) widest = target;
  }
  return widest;
}

std::string isa_in_use(const std::string& isa) {
  static std::mutex mutex;
  static std::map<std::string, std::string> known;
  const std::lock_guard lock(mutex);
  const auto [entry, is_new] = known.try_emplace(isa);
  if (is_new) {
    const CaptureStandardOutput capture;
    const Device device((device_config(isa) + ",verbose=1").c_str());
    entry->second = widest_target(capture.text());
  }
  return entry->second;
}

void require_isa(const std::string& isa) {
  targets_of(isa);
  const std::string used = isa_in_use(isa);
  if (isa != "best") {
    const auto requested = std::ranges::find(kIsas, isa, &Isa::parameter);
    if (requested == kIsas.end() || used == requested->printed) return;
    throw InputError(fmt::format(
        "embree cannot be restricted to isa={}: it runs on {} instead; choose isa=best or another",
        isa, used));
  }
  const Isa* const best = best_of_machine();
  if (best == nullptr) return;
  const auto found = std::ranges::find(kIsas, used, &Isa::printed);
  if (found <= best) return;
  throw InputError(fmt::format(
      "Embree runs on {} although the machine has {}, so ratios to it would be misleading; install "
      "an Embree with {}, or give isa=... to restrict embree and the structures compared with it",
      used, best->printed, best->printed));
}

std::string embree_version() {
  static const std::string version = [] {
    const Device device("threads=1");
    const auto part = [&](RTCDeviceProperty property) {
      return static_cast<long>(rtcGetDeviceProperty(device.get(), property));
    };
    return fmt::format("{}.{}.{}", part(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                       part(RTC_DEVICE_PROPERTY_VERSION_MINOR),
                       part(RTC_DEVICE_PROPERTY_VERSION_PATCH));
  }();
  return version;
}

}  // namespace beambench::accel::embree
