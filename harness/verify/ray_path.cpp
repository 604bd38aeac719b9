#include "harness/verify/ray_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "accel/core/inspector_of.hpp"
#include "accel/core/intersect.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/describe.hpp"
#include "harness/verify/hit_json.hpp"
#include "harness/verify/verify_ray.hpp"

namespace beambench::verify {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kListedMisses = 40;  // in the text; the JSON has all misses

/// The outcome of a ray-primitive test. A primitive beyond the best hit does not count as missed.
struct TestOutcome {
  scenes::PrimitiveId primitive;
  bool hit;
  float t;  ///< kMiss if the ray misses it completely
};

/// The tests of a path with the best hit after each step.
class Account {
 public:
  Account(const scenes::Scene& scene, const accel::Ray& ray) : scene_(scene), ray_(ray) {}

  std::vector<TestOutcome> take(const accel::TraceStep& step) {
    std::vector<TestOutcome> outcomes;
    for (const accel::TestedPrimitive& test : step.tests) {
      const bool hit = accel::is_hit(test.t);
      outcomes.push_back(
          {test.primitive, hit, hit ? test.t : accel::intersect(ray_, scene_, test.primitive)});
      const accel::Hit found{test.t, test.primitive};
      if (hit && (!best_ || accel::precedes(found, *best_))) best_ = found;
    }
    return outcomes;
  }
  const std::optional<accel::Hit>& best() const { return best_; }

 private:
  const scenes::Scene& scene_;
  accel::CanonicalRay ray_;
  std::optional<accel::Hit> best_;
};

std::string text(const glm::dvec3& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

std::string tests_text(const std::vector<TestOutcome>& outcomes) {
  std::string out;
  std::vector<scenes::PrimitiveId> missed;
  for (const TestOutcome& outcome : outcomes) {
    if (outcome.hit) {
      out += fmt::format("primitive {} is hit at t = {}\n", outcome.primitive, outcome.t);
    } else if (accel::is_hit(outcome.t)) {
      out += fmt::format("primitive {} would be hit at t = {}, beyond the best\n",
                         outcome.primitive, outcome.t);
    } else {
      missed.push_back(outcome.primitive);
    }
  }
  if (missed.empty()) return out;
  const auto listed = std::span(missed).first(std::min(missed.size(), kListedMisses));
  const std::size_t more = missed.size() - listed.size();
  return out + fmt::format("missed: {}{}\n", fmt::join(listed, " "),
                           more > 0 ? fmt::format(" and {} more", more) : "");
}

std::string step_text(std::size_t number, const accel::TraceStep& step, std::string_view untested,
                      Account& account) {
  std::string head = fmt::format("{:4}  {}", number, step.place);
  if (step.box) head += fmt::format(" {}", step.index);
  if (step.level > 0) head += fmt::format(", level {}", step.level);
  if (step.box) head += fmt::format(", {} to {}", text(step.box->lower), text(step.box->upper));
  head += fmt::format(", t in [{:.9g}, {:.9g}]\n", step.t_enter, step.t_exit);

  std::string body =
      step.tests.empty() ? std::string(untested) + "\n" : tests_text(account.take(step));
  if (account.best()) {
    body += fmt::format("best so far: primitive {} at t = {}\n", account.best()->primitive,
                        account.best()->t);
  }
  std::string out = head;
  for (std::size_t begin = 0; begin < body.size();) {
    const std::size_t end = body.find('\n', begin) + 1;
    out += "        " + body.substr(begin, end - begin);
    begin = end;
  }
  return out;
}

std::string plane_text(const accel::CrossedPlane& plane) {
  return fmt::format("{} = {:.9g}", "xyz"[plane.axis], plane.at);
}

constexpr std::array<std::string_view, 3> kBeamMeets{"empty leaf", "occupied leaf", "leaves leaf"};
constexpr std::array<std::string_view, 3> kBeamKinds{"non-terminal", "occupied", "leaving"};

/// Returns why the beams end here.
std::string_view end_text(const accel::BeamPassage& last) {
  switch (last.kind) {
    case accel::BeamKind::kLeaving:
      return "terminal: the scene's end, the background";
    case accel::BeamKind::kOccupied:
      return "terminal: its samples become rays";
    case accel::BeamKind::kNonTerminal:
      return "its samples become rays here (handover)";
  }
  return "";
}

std::string passage_text(std::size_t number, const accel::BeamPassage& beam, bool is_last) {
  std::string out = fmt::format("{:4}  {} {}, level {}, {} to {}", number,
                                kBeamMeets[static_cast<std::size_t>(beam.kind)], beam.node,
                                beam.level, text(beam.cell.lower), text(beam.cell.upper));
  if (beam.entered) {
    out += fmt::format(", by {}", plane_text(*beam.entered));
  } else {
    out += ", the camera is in it";
  }
  out += fmt::format(
      "\n        {} samples; {}\n", beam.samples,
      is_last ? end_text(beam)
              : (beam.kind == accel::BeamKind::kOccupied ? "continues behind it" : "non-terminal"));
  if (beam.cuts.empty()) out += "        not cut\n";
  for (const accel::PlaneOrder& cut : beam.cuts) {
    out += fmt::format("        cut: crosses {} before {}\n", plane_text(cut.first),
                       plane_text(cut.second));
  }
  std::vector<std::string> corners;
  for (const glm::dvec2& corner : beam.corners) {
    corners.push_back(fmt::format("({:.2f}, {:.2f})", corner.x, corner.y));
  }
  return out + fmt::format("        outline: {}\n", fmt::join(corners, " "));
}

std::string beams_text(const RayPath& path) {
  if (path.beams.empty()) return "";
  std::string out = fmt::format("The sample's beams, {} {}; outlines in pixels:\n",
                                path.beams.size(), path.beams.size() == 1 ? "leaf" : "leaves");
  for (std::size_t i = 0; i < path.beams.size(); ++i) {
    out += passage_text(i + 1, path.beams[i], i + 1 == path.beams.size());
  }
  return out + (path.steps.empty() ? "" : "\nThe sample as a ray:\n");
}

std::string counters_text(const RayPath& path) {
  std::vector<std::string> parts;
  for (const auto& [name, count] : path.counters) {
    if (count > 0) parts.push_back(fmt::format("{} {}", name, count));
  }
  if (parts.empty()) return "";
  return fmt::format("  work      {}{}\n",
                     path.beams.empty() ? "" : "without beams: ", fmt::join(parts, ", "));
}

bool same(const std::optional<accel::Hit>& a, const std::optional<accel::Hit>& b) {
  return a.has_value() == b.has_value() && (!a || *a == *b);
}

std::string alone_text(const RayPath& path) {
  if (!path.asked_all || path.verified.query == rays::Query::kAnyHit) return "";
  if (same(path.alone, path.verified.answer)) return "";
  return fmt::format(
      "  alone     {}: traced without the other rays\n",
      path.alone ? fmt::format("primitive {} at t = {}", path.alone->primitive, path.alone->t)
                 : "miss");
}

Json plane_json(const accel::CrossedPlane& plane) {
  return {{"axis", std::string(1, "xyz"[plane.axis])}, {"at", plane.at}};
}

Json passage_json(const accel::BeamPassage& beam) {
  Json out{
      {"kind", kBeamKinds[static_cast<std::size_t>(beam.kind)]},
      {"index", beam.node},
      {"level", beam.level},
      {"box", {{"lower", vector_json(beam.cell.lower)}, {"upper", vector_json(beam.cell.upper)}}},
      {"entered", beam.entered ? plane_json(*beam.entered) : Json()},
      {"samples", beam.samples},
      {"outline", Json::array()},
      {"cuts", Json::array()}};
  for (const glm::dvec2& corner : beam.corners) {
    out["outline"].push_back(Json::array({corner.x, corner.y}));
  }
  for (const accel::PlaneOrder& cut : beam.cuts) {
    out["cuts"].push_back({{"first", plane_json(cut.first)}, {"second", plane_json(cut.second)}});
  }
  return out;
}

Json step_json(const accel::TraceStep& step, Account& account) {
  Json out{{"place", step.place}};
  if (step.box) {
    out["index"] = step.index;
    if (step.level > 0) out["level"] = step.level;
    out["box"] = {{"lower", vector_json(step.box->lower)}, {"upper", vector_json(step.box->upper)}};
  }
  out["t_enter"] = step.t_enter;
  out["t_exit"] = step.t_exit;
  out["tests"] = Json::array();
  for (const TestOutcome& outcome : account.take(step)) {
    Json test{{"primitive", outcome.primitive}, {"hit", outcome.hit}, {"t", nullptr}};
    if (accel::is_hit(outcome.t)) test["t"] = outcome.t;
    out["tests"].push_back(std::move(test));
  }
  out["best"] = hit_json(account.best());
  return out;
}

/// Traces one ray and stores its hit.
void answer_alone(const accel::Accelerator& structure, const accel::Ray& ray, std::size_t index,
                  rays::TraceResults& results) {
  if (auto* any = std::get_if<rays::AnyHits>(&results)) {
    (*any)[index] = structure.any_hit(ray, nullptr) ? 1 : 0;
  } else {
    std::get<accel::HitBuffer>(results).set(index, structure.closest_hit(ray, nullptr));
  }
}

}  // namespace

RayPath trace_path(const accel::StructureChoice& choice, const scenes::Scene& scene,
                   const rays::ImageOfRays& image, const rays::TraceInput& input, std::size_t index,
                   bool alone, base::Progress& progress) {
  const accel::Ray ray = input.ray(index);
  const auto accelerator = choice.build(scene, rays::workload_of(image, input));
  const accel::oracle::Oracle oracle(scene, input.reach());
  RayPath path{choice.short_label(), image, input, {}, {}, {}, {}, !alone, {}};
  accel::WorkCounters counters;
  accelerator->closest_hit(ray, &counters);
  path.counters = counters.by_name();
  const accel::Inspector& inspector = accel::inspector_of(*accelerator);
  if (input.image() != nullptr && !alone) {
    const rays::PixelSample at = *input.pixel(index);
    accel::SampleSteps in_image = inspector.path(*input.image(), at.x, at.y, at.sample);
    path.beams = std::move(in_image.beams);
    path.steps = std::move(in_image.steps);
  } else {
    path.steps = inspector.path(ray);
  }
  path.alone = accelerator->closest_hit(ray, nullptr);
  rays::TraceResults results = rays::make_results(input);
  if (alone) {
    answer_alone(*accelerator, ray, index, results);
  } else {
    progress.start(fmt::format("{} over {}", choice.info().name, scene.name));
    rays::trace_with_progress(*accelerator, input, results, 1, progress);
  }
  path.verified = candidate_mismatch(input, results, index, oracle.closest_hit(ray));
  verify_ray(scene, choice.info().conformance, path.verified);
  return path;
}

std::string to_text(const scenes::Scene& scene, const RayPath& path) {
  const int samples = path.image.samples;
  std::string out =
      fmt::format("{} by {}, {} rays, {} pixels with {} {} each\n\n", scene.name, path.structure,
                  path.input.label(), rays::to_string(path.image.resolution), samples,
                  samples == 1 ? "sample" : "samples");
  out += beams_text(path);
  Account account(scene, path.verified.ray);
  for (std::size_t i = 0; i < path.steps.size(); ++i) {
    // In the leaf where the sample's beam ends, the images of the primitives on the screen are
    // tested first.
    const bool by_images = i == 0 && !path.beams.empty();
    out += step_text(i + 1, path.steps[i],
                     by_images ? "no test: the sample lies outside of the primitives' images"
                               : "nothing to test",
                     account);
  }
  if (path.steps.empty() && path.beams.empty()) {
    out += fmt::format(
        "{} lists no steps: the ray entered nothing, or the structure cannot list steps\n",
        path.structure);
  }
  return out + '\n' + describe(scene, path.input, path.verified) + alone_text(path) +
         counters_text(path);
}

nlohmann::ordered_json to_json(const scenes::Scene& scene, const RayPath& path) {
  const Mismatch& verified = path.verified;
  const accel::Ray& ray = verified.ray;
  Json out{{"scene", scene.name},
           {"structure", path.structure},
           {"width", path.image.resolution.width},
           {"height", path.image.resolution.height},
           {"samples", path.image.samples},
           {"ray_kind", path.input.label()},
           {"query", rays::to_string(verified.query)},
           {"index", verified.index}};
  if (const auto pixel = path.input.pixel(verified.index)) {
    out["pixel"] = {pixel->x, pixel->y};
    out["sample"] = pixel->sample;
  }
  out["ray"] = ray_json(ray);
  if (!path.beams.empty()) {
    out["beams"] = Json::array();
    for (const accel::BeamPassage& beam : path.beams) out["beams"].push_back(passage_json(beam));
  }
  out["steps"] = Json::array();
  out["counters"] = path.counters;
  if (verified.query == rays::Query::kAnyHit) {
    out["any_hit"] = verified.any_hit_answer;
  } else {
    out["hit"] = hit_json(verified.answer);
  }
  out["hit_alone"] = hit_json(path.alone);
  out["asked_all"] = path.asked_all;
  out["oracle"] = hit_json(verified.oracle);
  Account account(scene, ray);
  for (const accel::TraceStep& step : path.steps) out["steps"].push_back(step_json(step, account));
  if (verified.searched) out["exact"] = hit_json(verified.exact);
  out["class"] = kRecordedClassNames[static_cast<std::size_t>(verified.diff_class)];
  out["reason"] = verified.reason;
  return out;
}

}  // namespace beambench::verify
