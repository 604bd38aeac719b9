#include "accel/embree/version.hpp"

#include <algorithm>
#include <iostream>
#include <sstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "accel/embree/device.hpp"

namespace beambench {
namespace {

/// Sends std::cout into a string for as long as it lives.
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

/// The words between `from`, or the ": " before it on its line, and `mark` on one line of `text`.
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

std::string find_isa() {
  std::string text;
  {
    const CaptureStandardOutput capture;
    const embree::Device device("verbose=1");
    text = capture.text();
  }
  // "Targets : SSE ... AVX512 (supported)" and below "SSE2 ... AVX512 (compile time enabled)",
  // both from the narrowest to the widest.
  const std::vector<std::string> supported = words_before(text, "(supported)");
  std::string isa = "unknown";
  for (const std::string& target : words_before(text, "(compile time enabled)")) {
    if (std::find(supported.begin(), supported.end(), target) != supported.end()) isa = target;
  }
  return isa;
}

}  // namespace

std::string embree_version() {
  const embree::Device device("threads=1");
  const auto part = [&](RTCDeviceProperty property) {
    return static_cast<long>(rtcGetDeviceProperty(device.get(), property));
  };
  return fmt::format("{}.{}.{}", part(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                     part(RTC_DEVICE_PROPERTY_VERSION_MINOR),
                     part(RTC_DEVICE_PROPERTY_VERSION_PATCH));
}

std::string embree_isa() {
  static const std::string isa = find_isa();
  return isa;
}

}  // namespace beambench
