#include "harness/cli/ray_way.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "accel/core/intersect.hpp"
#include "harness/cli/text.hpp"
#include "harness/verify/describe.hpp"

namespace beambench::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kListedMisses = 40;  // in the text; the JSON has them all

/// What a ray-primitive test came to. A primitive beyond the best hit is not missed by the ray.
struct TestOutcome {
  scenes::PrimitiveId primitive;
  bool hit;
  float t;  ///< kMiss where the ray misses it altogether
};

/// The tests of a way with the best hit after each step.
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
      out += fmt::format("primitive {} would be hit at t = {}, behind the best\n",
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

std::string plane_text(const accel::beam::CrossedPlane& plane) {
  return fmt::format("{} = {:.9g}", "xyz"[plane.axis], plane.at);
}

constexpr std::array<std::string_view, 3> kBeamMeets{"empty leaf", "occupied leaf", "leaves leaf"};
constexpr std::array<std::string_view, 3> kBeamKinds{"non-terminal", "occupied", "leaving"};

/// Why there is no further beam.
std::string_view end_text(const accel::beam::BeamPassage& last) {
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

std::string passage_text(std::size_t number, const accel::beam::BeamPassage& beam, bool is_last) {
  std::string out = fmt::format("{:4}  {} {}, level {}, {} to {}", number,
                                kBeamMeets[static_cast<std::size_t>(beam.kind)], beam.node,
                                beam.level, text(beam.cell.lower), text(beam.cell.upper));
  if (beam.entered) {
    out += fmt::format(", by {}", plane_text(*beam.entered));
  } else {
    out += ", the eye is in it";
  }
  out += fmt::format(
      "\n        {} samples; {}\n", beam.samples,
      is_last ? end_text(beam)
              : (beam.kind == accel::BeamKind::kOccupied ? "goes on behind it" : "non-terminal"));
  if (beam.cuts.empty()) out += "        not cut\n";
  for (const accel::beam::PlaneOrder& cut : beam.cuts) {
    out += fmt::format("        cut: crosses {} before {}\n", plane_text(cut.first),
                       plane_text(cut.second));
  }
  std::vector<std::string> corners;
  for (const glm::dvec2& corner : beam.corners) {
    corners.push_back(fmt::format("({:.2f}, {:.2f})", corner.x, corner.y));
  }
  return out + fmt::format("        outline: {}\n", fmt::join(corners, " "));
}

std::string beams_text(const RayWay& way) {
  if (way.beams.empty()) return "";
  std::string out = fmt::format("The sample's beams, {} {}; outlines in pixels:\n",
                                way.beams.size(), way.beams.size() == 1 ? "leaf" : "leaves");
  for (std::size_t i = 0; i < way.beams.size(); ++i) {
    out += passage_text(i + 1, way.beams[i], i + 1 == way.beams.size());
  }
  return out + (way.steps.empty() ? "" : "\nThe sample as a ray:\n");
}

std::string counters_text(const RayWay& way) {
  std::vector<std::string> parts;
  for (const auto& [name, count] : way.counters) {
    if (count > 0) parts.push_back(fmt::format("{} {}", name, count));
  }
  if (parts.empty()) return "";
  return fmt::format("  work   {}{}\n",
                     way.beams.empty() ? "" : "without beams: ", fmt::join(parts, ", "));
}

bool same(const std::optional<accel::Hit>& a, const std::optional<accel::Hit>& b) {
  return a.has_value() == b.has_value() && (!a || *a == *b);
}

std::string alone_text(const RayWay& way) {
  if (!way.asked_all || way.judgment.query == rays::Query::kAnyHit) return "";
  if (same(way.alone, way.judgment.answer)) return "";
  return fmt::format("  alone  {}: asked without the other rays\n",
                     way.alone
                         ? fmt::format("primitive {} at t = {}", way.alone->primitive, way.alone->t)
                         : "miss");
}

template <class AnyHit>
Json hit_json(const std::optional<AnyHit>& hit) {
  if (!hit) return nullptr;
  return {{"primitive", hit->primitive}, {"t", hit->t}};
}

template <class Vector>
Json vector_json(const Vector& v) {
  return Json::array({v.x, v.y, v.z});
}

/// What is infinite has no number in JSON.
Json number_json(float value) { return std::isinf(value) ? Json() : Json(value); }

Json plane_json(const accel::beam::CrossedPlane& plane) {
  return {{"axis", std::string(1, "xyz"[plane.axis])}, {"at", plane.at}};
}

Json passage_json(const accel::beam::BeamPassage& beam) {
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
  for (const accel::beam::PlaneOrder& cut : beam.cuts) {
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

}  // namespace

std::string to_text(const scenes::Scene& scene, const RayWay& way) {
  const int samples = way.image.samples;
  std::string out =
      fmt::format("{} by {}, {} rays, {} pixels with {} {} each\n\n", scene.name, way.structure,
                  way.input.label(), rays::to_string(way.image.resolution), samples,
                  samples == 1 ? "sample" : "samples");
  out += beams_text(way);
  Account account(scene, way.judgment.ray);
  for (std::size_t i = 0; i < way.steps.size(); ++i) {
    // In the leaf where its beam ends, the images of the primitives on the screen are looked at
    // first.
    const bool by_images = i == 0 && !way.beams.empty();
    out += step_text(i + 1, way.steps[i],
                     by_images ? "no test: the sample lies outside of the primitives' images"
                               : "nothing to test",
                     account);
  }
  if (way.steps.empty() && way.beams.empty()) {
    out += fmt::format("{} tells no steps: it entered nothing, or cannot tell\n", way.structure);
  }
  return out + '\n' + verify::describe(scene, way.input, way.judgment) + alone_text(way) +
         counters_text(way);
}

nlohmann::ordered_json to_json(const scenes::Scene& scene, const RayWay& way) {
  const verify::Mismatch& judgment = way.judgment;
  const accel::Ray& ray = judgment.ray;
  Json out{{"scene", scene.name},
           {"structure", way.structure},
           {"width", way.image.resolution.width},
           {"height", way.image.resolution.height},
           {"samples", way.image.samples},
           {"ray_kind", way.input.label()},
           {"query", rays::to_string(judgment.query)},
           {"index", judgment.index}};
  if (const auto pixel = way.input.pixel(judgment.index)) {
    out["pixel"] = {pixel->x, pixel->y};
    out["sample"] = pixel->sample;
  }
  out["ray"] = {{"origin", vector_json(ray.origin)},
                {"direction", vector_json(ray.direction)},
                {"t_min", ray.t_min},
                {"t_max", number_json(ray.t_max)}};
  if (!way.beams.empty()) {
    out["beams"] = Json::array();
    for (const accel::beam::BeamPassage& beam : way.beams)
      out["beams"].push_back(passage_json(beam));
  }
  out["steps"] = Json::array();
  out["counters"] = way.counters;
  if (judgment.query == rays::Query::kAnyHit) {
    out["any_hit"] = judgment.any_hit_answer;
  } else {
    out["hit"] = hit_json(judgment.answer);
  }
  out["hit_alone"] = hit_json(way.alone);
  out["asked_all"] = way.asked_all;
  out["oracle"] = hit_json(judgment.oracle);
  Account account(scene, ray);
  for (const accel::TraceStep& step : way.steps) out["steps"].push_back(step_json(step, account));
  if (judgment.searched) out["exact"] = hit_json(judgment.exact);
  out["class"] = verify::kDiffClassNames[static_cast<std::size_t>(judgment.diff_class)];
  out["reason"] = judgment.reason;
  return out;
}

}  // namespace beambench::cli
