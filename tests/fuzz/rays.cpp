// Ray files, binary and CSV: rays that were read can be written and read back bit for bit.

#include <algorithm>
#include <cstring>

#include <nlohmann/json.hpp>

#include "harness/rays/ray_file.hpp"
#include "harness/rays/ray_set.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace beambench;

bool same_bits(const rays::RaySet& a, const rays::RaySet& b) {
  return a.rays.size() == b.rays.size() && a.pencils.size() == b.pencils.size() &&
         a.query == b.query && a.seed == b.seed &&
         (a.rays.empty() ||
          std::memcmp(a.rays.data(), b.rays.data(), a.rays.size() * sizeof(accel::Ray)) == 0);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::ScratchFolder folder;
  const auto file = folder.write("input.rays", fuzz::text_of(data, size));
  const auto set = fuzz::accepted([&] { return rays::read_ray_file(file); });
  if (!set) return 0;
  const auto written = folder.path() / "written.rays";
  rays::write_ray_file(written, *set, {});
  fuzz::require(same_bits(rays::read_ray_file(written), *set),
                "rays that were written differ when they are read again");
  return 0;
}
