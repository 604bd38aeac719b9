#include "accel/core/instruction_set.hpp"

#include <vector>

#include <fmt/format.h>
#include <hwy/targets.h>

#include "scenes/base/error.hpp"

namespace beambench::accel {
namespace {

std::int64_t all_of(const std::string& isa) {
#if HWY_ARCH_X86
  // The better a target, the lower its bit; several bits below AVX2's are variants of AVX-512.
  if (isa == "avx512") return HWY_AVX2 - 1;
  if (isa == "avx2") return HWY_AVX2;
  if (isa == "sse4") return HWY_SSE4;
#endif
  return isa == "best" ? ~std::int64_t{0} : 0;
}

}  // namespace

ParameterInfo isa_parameter() {
  std::vector<std::string> sets{"best"};
#if HWY_ARCH_X86
  sets.insert(sets.end(), {"avx512", "avx2", "sse4"});
#endif
  return choice_parameter("isa", "best", sets,
                          "the instruction set to use: the machine's best, or an older one to "
                          "compare on equal terms");
}

bool is_available(const std::string& isa) {
  return (all_of(isa) & hwy::SupportedTargets() & HWY_TARGETS) != 0;
}

std::int64_t targets_of(const std::string& isa) {
  if (!is_available(isa)) {
    throw InputError(
        fmt::format("isa is {}, which this machine does not support; choose isa=best or "
                    "an older instruction set",
                    isa));
  }
  return all_of(isa);
}

void restrict_to(const std::string& isa) { hwy::DisableTargets(~targets_of(isa)); }

std::string best_simd_target() {
  return hwy::TargetName(hwy::SupportedAndGeneratedTargets().front());
}

}  // namespace beambench::accel
