#include "harness/python/arrays.hpp"

#include <string_view>

#include <fmt/format.h>

#include "scenes/base/error.hpp"

namespace beambench::python {

std::string ray_fault(std::size_t index, std::string fault) {
  constexpr std::string_view kSubject = "ray ";
  if (fault.starts_with(kSubject)) fault.erase(0, kSubject.size());
  return fmt::format("ray {}: {}", index, fault);
}

void require_valid_rays(std::span<const accel::Ray> rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    try {
      accel::require_valid(rays[i]);
    } catch (const InputError& error) {
      throw InputError(ray_fault(i, error.what()));
    }
  }
}

}  // namespace beambench::python
