#pragma once
// Compares hits bit by bit, and lists the structures whose single rays must match exhaustive
// search.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "accel/core/ray.hpp"
#include "accel/core/registry.hpp"

namespace beambench::tests {

/// Compares bits: distinguishes -0 from 0, which compare equal.
inline std::optional<std::pair<std::uint32_t, scenes::PrimitiveId>> bits_of(
    const std::optional<accel::Hit>& hit) {
  if (!hit) return std::nullopt;
  return std::pair{std::bit_cast<std::uint32_t>(hit->t), hit->primitive};
}

/// All bit-exact structures that trace single rays, and `tile-beam`, whose single rays are
/// bit-exact.
inline std::vector<std::string> exact_structures() {
  std::vector<std::string> names{"tile-beam"};
  for (const accel::StructureInfo& info : accel::registry().structures()) {
    if (info.conformance != accel::Conformance::kBitExact) continue;
    if (info.support.single_rays) names.push_back(info.name);
  }
  return names;
}

inline std::string name_of_structure(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

}  // namespace beambench::tests
