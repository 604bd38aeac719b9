#include "harness/cli/work_picture.hpp"

#include <algorithm>
#include <functional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/core/error.hpp"

namespace beambench::cli {
namespace {

using Names = std::set<std::string, std::less<>>;

/// Reads one counter. A name of the family's own may be absent from a ray that did no such work.
std::uint64_t read(const accel::WorkCounters& counters, const std::string& name, Names& seen) {
  const auto standard = std::find(accel::kCounterNames.begin(), accel::kCounterNames.end(), name);
  if (standard != accel::kCounterNames.end()) {
    return counters.get(static_cast<accel::Counter>(standard - accel::kCounterNames.begin()));
  }
  std::uint64_t value = 0;
  for (const auto& [each, count] : counters.by_name()) {
    seen.insert(each);
    if (each == name) value = count;
  }
  return value;
}

void require_known(const std::string& counter, const Names& seen) {
  // Without a look by name there was nothing to see: the counter is a standard one.
  if (seen.empty() || seen.contains(counter)) return;
  throw InputError(fmt::format("this structure counts no '{}'; choose from: {}", counter,
                               fmt::join(seen, ", ")));
}

}  // namespace

render::HeatMap count_work(const accel::Accelerator& accelerator, const accel::PrimaryRays& rays,
                           const std::string& counter, accel::HitBuffer& hits,
                           base::Progress& progress) {
  render::HeatMap map{counter + " per ray", rays.width(), rays.height(), {}};
  Names seen;
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      std::uint64_t sum = 0;
      for (int sample = 0; sample < rays.samples(); ++sample) {
        accel::WorkCounters counters;
        const auto hit = accelerator.closest_hit(rays.ray(x, y, sample), &counters);
        hits.set(hits.index(x, y, sample), hit);
        sum += read(counters, counter, seen);
      }
      map.values.push_back(static_cast<float>(sum) / static_cast<float>(rays.samples()));
    }
    progress.advance(static_cast<double>(y + 1) / rays.height());
  }
  require_known(counter, seen);
  return map;
}

}  // namespace beambench::cli
