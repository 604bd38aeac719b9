#include "harness/measure/record/conditions.hpp"

#include <cstdint>

#include <fmt/format.h>

#include "harness/base/messages.hpp"
#include "harness/measure/record/cell_record.hpp"
#include "harness/measure/record/machine.hpp"

namespace beambench::measure {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the throttling stated in the JSON of a manifest.
std::optional<Throttling> throttling_of(const Json& manifest) {
  const Json stated = manifest.at("measurement").value("throttling", Json());
  if (stated.is_null()) return std::nullopt;
  return Throttling{stated.at("periods").get<std::uint64_t>(),
                    stated.at("throttled_periods").get<std::uint64_t>(),
                    stated.at("throttled_seconds").get<double>()};
}

}  // namespace

Json to_json(const std::optional<Throttling>& throttling) {
  if (!throttling) return {};
  return {{"periods", throttling->periods},
          {"throttled_periods", throttling->throttled},
          {"throttled_seconds", throttling->seconds}};
}

std::optional<std::string> noise_warning(const std::optional<double>& noise) {
  if (!noise || *noise <= kNoisy) return std::nullopt;
  return fmt::format(
      "The machine is disturbed: 5% of the slices of equal work took at least {:.0f}% longer than "
      "usual.",
      100.0 * *noise);
}

std::optional<std::string> quota_warning(const std::optional<double>& quota, int threads) {
  if (!quota || *quota >= threads) return std::nullopt;
  return fmt::format(
      "The process has a quota of {:.3g} CPUs, less than {} can use: the kernel throttles it.",
      *quota, base::counted(static_cast<std::size_t>(threads), "thread"));
}

std::optional<std::string> describe(const std::optional<Throttling>& throttling) {
  if (!throttling || throttling->throttled == 0) return std::nullopt;
  return fmt::format("the kernel throttled the process in {} of {} periods of its CPU quota",
                     throttling->throttled, throttling->periods);
}

Conditions conditions_of(const Json& manifest) {
  const Json& measurement = manifest.at("measurement");
  const Json& noise = measurement.at("noise");
  std::optional<double> other_load;
  if (measurement.contains("highest_load")) {
    other_load =
        measurement.at("highest_load").get<double>() - measurement.at("threads").get<int>();
  }
  return {noise.is_null() ? std::nullopt : std::optional(noise.get<double>()),
          manifest.at("machine").at("load_average").get<double>(), throttling_of(manifest),
          other_load};
}

}  // namespace beambench::measure
