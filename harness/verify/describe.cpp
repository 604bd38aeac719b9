#include "harness/verify/describe.hpp"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "harness/verify/hit_json.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/base/shell_word.hpp"

namespace beambench::verify {
namespace {

std::string vector_text(const glm::vec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

/// Returns the options that select the camera: none for the first, a name, or the view itself if it
/// is not one of the scene's cameras.
std::string view_options(const scenes::Scene& scene, const scenes::Camera& camera) {
  if (camera.name == scene.cameras.front().name) return "";
  const bool of_scene = std::ranges::any_of(
      scene.cameras, [&](const scenes::Camera& each) { return each.name == camera.name; });
  if (of_scene) return " --camera " + shell_quoted(camera.name);
  return fmt::format(" --from {} --at {} --up {} --angle {}", vector_text(camera.from),
                     vector_text(camera.at), vector_text(camera.up), camera.angle);
}

std::string_view kind_of(const scenes::Scene& scene, scenes::PrimitiveId id) {
  if (id >= scene.primitives.size()) return "not in the scene";
  switch (scene.primitives[id].kind) {
    case scenes::PrimitiveKind::kSphere:
      return "sphere";
    case scenes::PrimitiveKind::kCone:
      return "cone";
    case scenes::PrimitiveKind::kPolygon:
      return "polygon";
  }
  return "unknown";
}

/// Floats and doubles are printed with enough digits to distinguish neighbors.
template <class AnyHit>
std::string text(const scenes::Scene& scene, const std::optional<AnyHit>& hit) {
  if (!hit) return "miss";
  if (hit->primitive == scenes::kNoPrimitive)
    return fmt::format("no primitive, but t = {}", hit->t);
  return fmt::format("primitive {} ({}) at t = {}", hit->primitive, kind_of(scene, hit->primitive),
                     hit->t);
}

std::string text(const glm::vec3& vector) {
  return fmt::format("({}, {}, {})", vector.x, vector.y, vector.z);
}

std::string answer_text(const scenes::Scene& scene, const Mismatch& mismatch) {
  if (mismatch.query == rays::Query::kClosestHit) return text(scene, mismatch.answer);
  if (mismatch.any_hit_answer > 1) return "neither 0 nor 1";
  return mismatch.any_hit_answer == 1 ? "some hit" : "no hit";
}

/// Returns the name of the mismatch's class, or "leak".
std::string_view name_among(std::span<const std::string_view> names, const Mismatch& mismatch) {
  return mismatch.leaked ? "leak" : names[static_cast<std::size_t>(mismatch.diff_class)];
}

}  // namespace

ReplayCommand::ReplayCommand(std::string_view program, const scenes::Scene& scene,
                             const rays::ImageOfRays& image,
                             const accel::StructureChoice& structure, const rays::TraceInput& input,
                             std::uint32_t frame)
    : input_(input),
      subject_(fmt::format("{} trace {} --accel {}", program,
                           shell_quoted(path_of_name(scene.name)),
                           shell_quoted(structure.short_label()))),
      image_(fmt::format("--resolution {}", rays::to_string(image.resolution))) {
  if (frame > 0) subject_ += fmt::format(" --frame {}", frame);
  if (image.samples > 1) image_ += fmt::format(" --samples {}", image.samples);
  image_ += view_options(scene, image.camera);
}

std::string ReplayCommand::of(std::size_t index) const {
  const auto pixel = input_.pixel(index);
  if (!pixel) {
    return fmt::format("{} --rays {} --ray {} {}", subject_,
                       shell_quoted(path_of_name(input_.label())), index, image_);
  }
  const std::string which =
      input_.image()->samples() > 1 ? fmt::format(" --sample {}", pixel->sample) : "";
  return fmt::format("{} --pixel {},{} {}{}", subject_, pixel->x, pixel->y, image_, which);
}

std::string describe(const scenes::Scene& scene, std::string_view place, const Mismatch& mismatch,
                     std::string_view subject) {
  return fmt::format(
      "{}: {}{}{}\n"
      "  ray       from {} along {}, t in [{}, {}]\n"
      "  {:<9} {}\n"
      "  oracle    {}\n"
      "  exact     {}\n",
      place, name_among(kDiffClassNames, mismatch), mismatch.reason.empty() ? "" : ", ",
      mismatch.reason, text(mismatch.ray.origin), text(mismatch.ray.direction), mismatch.ray.t_min,
      mismatch.ray.t_max, subject, answer_text(scene, mismatch), text(scene, mismatch.oracle),
      mismatch.searched ? text(scene, mismatch.exact) : "not searched");
}

std::string describe(const scenes::Scene& scene, const Mismatch& mismatch) {
  return describe(scene, fmt::format("ray {}", mismatch.index), mismatch, "reported");
}

std::string describe(const scenes::Scene& scene, const rays::TraceInput& input,
                     const Mismatch& mismatch) {
  return describe(scene, rays::place_text(input, mismatch.index), mismatch, "structure");
}

std::string describe(const scenes::Scene& scene, const rays::TraceInput& input,
                     const Mismatch& mismatch, const ReplayCommand& replay) {
  return fmt::format("{}  replay {}\n", describe(scene, input, mismatch),
                     replay.of(mismatch.index));
}

nlohmann::ordered_json to_json(const Mismatch& mismatch) {
  nlohmann::ordered_json out{{"index", mismatch.index},
                             {"class", name_among(kRecordedClassNames, mismatch)},
                             {"reason", mismatch.reason},
                             {"ray", ray_json(mismatch.ray)}};
  if (mismatch.query == rays::Query::kAnyHit) {
    out["reported"] = mismatch.any_hit_answer;
  } else {
    out["reported"] = hit_json(mismatch.answer);
  }
  out["oracle"] = hit_json(mismatch.oracle);
  if (mismatch.searched) out["exact"] = hit_json(mismatch.exact);
  return out;
}

}  // namespace beambench::verify
