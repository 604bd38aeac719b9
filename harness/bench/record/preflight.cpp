#include "harness/bench/record/preflight.hpp"

#include <fmt/format.h>

namespace beambench::bench {
namespace {

/// Above this the slowest twentieth of equal work says that others are at work.
constexpr double kNoisy = 0.05;

std::string or_unknown(const std::string& text) { return text.empty() ? "unknown" : text; }

std::string hardware_line(const Manifest& manifest) {
  const Machine& machine = manifest.machine;
  const int core = manifest.measurement.pinned_core;
  return fmt::format(
      "machine: {}, {} cores, {}, Embree {}, MXCSR 0x{:04x}, {}, pages of {} KiB (huge: {})",
      machine.cpu, machine.cores, machine.instructions, manifest.run.isa,
      manifest.measurement.control_word, core < 0 ? "not pinned" : fmt::format("core {}", core),
      machine.page_bytes / 1024, or_unknown(machine.huge_pages));
}

std::string state_line(const Manifest& manifest) {
  const Machine& machine = manifest.machine;
  const auto& noise = manifest.measurement.noise;
  return fmt::format("machine: governor {}, turbo {}, load {:.2f}, noise {}, hardware counters {}",
                     or_unknown(machine.governor), or_unknown(machine.turbo), machine.load,
                     noise ? fmt::format("{:.1f}%", 100.0 * *noise) : "not measured",
                     manifest.measurement.hardware_problem.empty() ? "yes" : "no");
}

}  // namespace

std::optional<std::string> noise_warning(const std::optional<double>& noise) {
  if (!noise || *noise <= kNoisy) return std::nullopt;
  return fmt::format(
      "The machine is disturbed: one slice in twenty of equal work took at least {:.0f}% longer "
      "than usual.",
      100.0 * *noise);
}

std::vector<std::string> preflight(const Manifest& manifest) {
  std::vector<std::string> lines{hardware_line(manifest), state_line(manifest)};
  for (const std::string& sentence : manifest.uncontrolled) {
    lines.push_back(fmt::format("warning: {}", sentence));
  }
  return lines;
}

}  // namespace beambench::bench
