#pragma once
// Builds structures from specifications, and reports why one is refused.

#include <memory>
#include <string>

#include "accel/core/accelerator.hpp"
#include "accel/core/registry.hpp"
#include "scenes/base/error.hpp"
#include "scenes/scene.hpp"

namespace beambench::tests {

inline std::unique_ptr<accel::Accelerator> build(const std::string& spec,
                                                 const scenes::Scene& scene) {
  return accel::registry().choose(parse_spec(spec)).build(scene);
}

/// Returns the message of the InputError that refuses the structure.
inline std::string refusal(const std::string& spec, const scenes::Scene& scene) {
  try {
    build(spec, scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return "it was accepted";
}

}  // namespace beambench::tests
