#include "harness/measure/record/cell_record.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "harness/rays/fingerprint.hpp"

namespace beambench::measure {

std::string CellId::name() const {
  return fmt::format("{}/{}/{}/{}/{}/{}{}{}", scene, camera, rays::to_string(resolution), samples,
                     rays, structure, parameters.empty() ? "" : ":", parameters);
}

std::string CellId::key() const { return rays::hex_digits(rays::fingerprint(name())); }

std::string_view to_string(StopReason reason) {
  constexpr std::array<std::string_view, 3> kNames{"precision", "budget", "repetitions"};
  return kNames[static_cast<std::size_t>(reason)];
}

std::vector<double> second_traces(const CellRecord& cell) {
  std::vector<double> traces;
  for (const Repetition& repetition : cell.repetitions) {
    if (repetition.warm_trace_ms) traces.push_back(*repetition.warm_trace_ms);
  }
  return traces;
}

}  // namespace beambench::measure
