#pragma once
// The modes of the installed Embree; version 4 has one fewer.

#include <algorithm>
#include <string>
#include <vector>

#include "accel/core/registry.hpp"

namespace beambench::tests {

inline std::vector<std::string> embree_modes() {
  const accel::StructureChoice embree = accel::registry().choose({"embree", {}});
  return std::ranges::find(embree.info().parameters, "mode", &ParameterInfo::name)->choices;
}

}  // namespace beambench::tests
