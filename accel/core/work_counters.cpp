#include "accel/core/work_counters.hpp"

#include <numeric>

namespace beambench::accel {

void WorkCounters::add(std::string_view name, std::uint64_t amount) {
  const auto found = own_.find(name);
  if (found != own_.end()) {
    found->second += amount;
  } else {
    own_.emplace(name, amount);
  }
}

void WorkCounters::add(const WorkCounters& other) {
  for (std::size_t i = 0; i < standard_.size(); ++i) standard_[i] += other.standard_[i];
  for (std::size_t i = 0; i < tests_.size(); ++i) tests_[i] += other.tests_[i];
  for (const auto& [name, amount] : other.own_) add(name, amount);
}

std::map<std::string, std::uint64_t, std::less<>> WorkCounters::by_name() const {
  auto all = own_;
  for (std::size_t i = 0; i < kCounterNames.size(); ++i) {
    all.emplace(std::string(kCounterNames[i]), standard_[i]);
  }
  const std::uint64_t by_kind = std::accumulate(tests_.begin(), tests_.end(), std::uint64_t{0});
  if (by_kind == 0 || by_kind != get(Counter::kPrimitiveTests)) return all;
  for (std::size_t i = 0; i < tests_.size(); ++i) {
    all.emplace(std::string(kTestNames[i]), tests_[i]);
  }
  return all;
}

}  // namespace beambench::accel
