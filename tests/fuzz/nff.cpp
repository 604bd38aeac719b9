// NFF: a scene that was read can be written and read back unchanged.

#include <sstream>
#include <string>

#include "scenes/catalogue.hpp"
#include "scenes/formats/nff/nff_reader.hpp"
#include "scenes/formats/nff/nff_writer.hpp"
#include "scenes/scene.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace beambench;

std::string written(const scenes::Scene& scene) {
  std::ostringstream stream;
  scenes::nff::write_nff(scene, stream);
  return stream.str();
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  fuzz::accepted([&] { return scenes::nff::parse_nff(text, "input.nff", {.strict = true}); });
  const auto read = fuzz::accepted([&] { return scenes::nff::parse_nff(text, "input.nff"); });
  if (!read) return 0;
  const std::string once = written(read->scene);
  const scenes::Scene again = scenes::nff::parse_nff(once, "input.nff").scene;
  fuzz::require(scenes::scene_hash(again) == scenes::scene_hash(read->scene),
                "a scene that was written has different primitives when it is read again");
  fuzz::require(written(again) == once, "a scene that was read again is written differently");
  return 0;
}
