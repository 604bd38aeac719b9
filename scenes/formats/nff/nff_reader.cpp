#include "scenes/formats/nff/nff_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/camera.hpp"
#include "scenes/formats/nff/nff_tokens.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::nff {
namespace {

/// Collects remarks on a file. The same problem may occur on each of a million lines, so remarks
/// with the same cause are merged into one, with the first line and a count.
class NffNotes {
 public:
  /// Adds a remark; `message` is the remark on the first line with this cause.
  void add(const std::string& cause, const std::string& message);

  /// Returns the remarks in the order of their first lines.
  std::vector<std::string> messages() const;

 private:
  struct Note {
    std::string message;
    std::size_t repetitions = 0;
  };
  std::vector<Note> notes_;
  std::map<std::string, std::size_t> by_cause_;  // indices into notes_
};

void NffNotes::add(const std::string& cause, const std::string& message) {
  const auto [place, is_new] = by_cause_.try_emplace(cause, notes_.size());
  if (is_new) {
    notes_.push_back({message});
  } else {
    ++notes_[place->second].repetitions;
  }
}

std::vector<std::string> NffNotes::messages() const {
  std::vector<std::string> messages;
  for (const Note& note : notes_) {
    messages.push_back(note.repetitions == 0
                           ? note.message
                           : fmt::format("{} (and {} more)", note.message, note.repetitions));
  }
  return messages;
}

struct ViewWord {
  std::string_view word;
  void (*read)(NffTokens& tokens, const NffToken& word, Camera& camera);
};

constexpr std::size_t kRequired = 5;  // the first ones
constexpr std::array<ViewWord, 8> kWords = {{
    {"from", [](NffTokens& tokens, const NffToken&,
                Camera& camera) { camera.from = tokens.triple("the eye"); }},
    {"at", [](NffTokens& tokens, const NffToken&,
              Camera& camera) { camera.at = tokens.triple("the point looked at"); }},
    {"up", [](NffTokens& tokens, const NffToken&,
              Camera& camera) { camera.up = tokens.triple("the up vector"); }},
    {"angle", [](NffTokens& tokens, const NffToken&,
                 Camera& camera) { camera.angle = tokens.number("the angle"); }},
    {"resolution",
     [](NffTokens& tokens, const NffToken&, Camera& camera) {
       camera.width = static_cast<int>(tokens.integer("the width in pixels"));
       camera.height = static_cast<int>(tokens.integer("the height in pixels"));
     }},
    {"hither", [](NffTokens& tokens, const NffToken&,
                  Camera& camera) { camera.hither = tokens.number("the hither distance"); }},
    // beambench's own words, written in comments (kOwnComment).
    {"name", [](NffTokens& tokens, const NffToken& word,
                Camera& camera) { camera.name = tokens.rest_of_line(word, "the camera's name"); }},
    {"aspect", [](NffTokens& tokens, const NffToken&,
                  Camera& camera) { camera.aspect = tokens.number("the aspect"); }},
}};

/// Takes the lines that belong to `view`, the token `v`. The camera's name is empty if the file
/// does not state it. Throws InputError with file and line if a required line is missing.
Camera read_nff_view(NffTokens& tokens, const NffToken& view) {
  Camera camera;
  camera.name.clear();
  std::array<bool, kWords.size()> seen{};
  while (true) {
    const auto* const word = std::find_if(kWords.begin(), kWords.end(), [&](const ViewWord& w) {
      return w.word == tokens.peek().text;
    });
    if (word == kWords.end()) break;
    seen[static_cast<std::size_t>(word - kWords.begin())] = true;
    word->read(tokens, tokens.take(), camera);
  }
  for (std::size_t i = 0; i < kRequired; ++i) {
    if (!seen[i]) {
      tokens.refuse(view.line,
                    fmt::format("the view has no '{}'; v takes from, at, up, angle, hither and "
                                "resolution, each on a line",
                                kWords[i].word));
    }
  }
  return camera;
}

/// Reads one file, command by command, into a builder.
class NffReader {
 public:
  NffReader(std::string_view text, const std::string& file, ReadOptions options)
      : tokens_(text, file), builder_(file), options_(options) {}

  NffResult read() &&;

 private:
  struct Command {
    std::string_view word;
    void (NffReader::*read)();
  };
  static const std::array<Command, 9> kCommands;
  std::optional<Command> next_command() const;
  std::optional<Command> dialect_command() const;
  void skip_unknown();
  void note(std::size_t line, const std::string& cause, const std::string& more = "");

  void read_view();
  void read_background();
  void read_light();
  void read_light_of_a_dialect();
  void read_animated_light();
  void read_area_light();
  void read_surface();
  void read_finish();
  void read_surface_fields(Surface surface);
  void read_sphere();
  void read_cone();
  void read_polygon() { read_corners(false); }
  void read_smooth_polygon() { read_corners(true); }
  void read_corners(bool smooth);

  /// Runs a call of the builder and prefixes its errors with the file and line of the command.
  template <typename Add>
  void add(Add call) {
    try {
      call();
    } catch (const InputError& error) {
      tokens_.refuse(command_.line, error.what());
    }
  }

  /// Adds a primitive in the same way; a degenerate primitive is skipped if the options allow it.
  template <typename Add>
  void add_primitive(Add call) {
    add([&] {
      try {
        call();
      } catch (const DegeneratePrimitive& degenerate) {
        skip_degenerate(degenerate.what());
      }
    });
  }
  void skip_degenerate(const std::string& why);

  NffTokens tokens_;
  SceneBuilder builder_;
  ReadOptions options_;
  NffNotes notes_;
  NffToken command_;          // the command being read
  bool any_command_ = false;  // text before the first command may be an e-mail header
  std::size_t view_count_ = 0;
};

const std::array<NffReader::Command, 9> NffReader::kCommands = {{
    {"p", &NffReader::read_polygon},
    {"pp", &NffReader::read_smooth_polygon},
    {"s", &NffReader::read_sphere},
    {"c", &NffReader::read_cone},
    {"f", &NffReader::read_surface},
    {"l", &NffReader::read_light},
    {"la", &NffReader::read_light_of_a_dialect},
    {"b", &NffReader::read_background},
    {"v", &NffReader::read_view},
}};

NffResult NffReader::read() && {
  if (tokens_.peek().text == "nff" || tokens_.peek().text == "NFF") {
    tokens_.refuse(
        tokens_.peek().line,
        "this is a Sense8 WorldToolKit file, another format of the same name; convert it "
        "to Haines's Neutral File Format");
  }
  while (!tokens_.at_end()) {
    const std::optional<Command> command = next_command();
    if (!command) {
      skip_unknown();
      continue;
    }
    any_command_ = true;
    command_ = tokens_.take();
    (this->*command->read)();
  }
  if (!any_command_) {
    tokens_.refuse(1, "there is no NFF command (v, b, l, f, s, c, p or pp) in the file");
  }
  return {std::move(builder_).build(), notes_.messages()};
}

std::optional<NffReader::Command> NffReader::next_command() const {
  const NffToken& token = tokens_.peek();
  if (!token.starts_line) return std::nullopt;
  const auto* const command = std::find_if(kCommands.begin(), kCommands.end(),
                                           [&](const Command& c) { return c.word == token.text; });
  if (command != kCommands.end()) return *command;
  if (find_finish(token.text)) return Command{token.text, &NffReader::read_finish};
  return dialect_command();
}

/// `fp` has the fields of `f`, for surfaces with Phong instead of flat shading
/// (github.com/mfandre/raytracer, Scene.cc). It is accepted only with that number of fields,
/// because a truncated file has fewer.
std::optional<NffReader::Command> NffReader::dialect_command() const {
  constexpr std::size_t kFields = 8;
  const std::string_view word = tokens_.peek().text;
  if (word != "fp") return std::nullopt;
  NffTokens ahead = tokens_;
  ahead.take();
  std::size_t numbers = 0;
  for (; ahead.at_number(); ++numbers) ahead.take();
  if (numbers != kFields && !(numbers < kFields && ahead.at_end())) return std::nullopt;
  return Command{word, &NffReader::read_surface};
}

void NffReader::skip_unknown() {
  const NffToken unknown = tokens_.peek();
  if (any_command_ && tokens_.at_number()) {
    tokens_.refuse(unknown.line, fmt::format("found the number '{}' where a command should be; the "
                                             "command at line {} takes fewer numbers",
                                             excerpt(unknown.text), command_.line));
  }
  while (!tokens_.at_end() && !next_command()) tokens_.take();
  const std::string end =
      tokens_.at_end() ? "the end of the file" : fmt::format("line {}", tokens_.peek().line);
  note(unknown.line, fmt::format("unknown word '{}'", excerpt(unknown.text)),
       ", skipped up to " + end);
}

/// Reports a problem that does not prevent the file from being read.
void NffReader::note(std::size_t line, const std::string& cause, const std::string& more) {
  if (options_.strict) {
    tokens_.refuse(line, cause + "; correct the file, or read it without --strict");
  }
  notes_.add(cause, tokens_.located(line, cause + more));
}

void NffReader::skip_degenerate(const std::string& why) {
  if (options_.strict) {
    throw InputError(why + "; correct the file, or read it without --strict");
  }
  notes_.add("degenerate",
             tokens_.located(command_.line, "a degenerate primitive is skipped: " + why));
}

void NffReader::read_view() {
  Camera camera = read_nff_view(tokens_, command_);
  if (camera.name.empty()) {
    camera.name = view_count_ == 0 ? "default" : fmt::format("view {}", view_count_ + 1);
  }
  ++view_count_;
  add([&] { builder_.add_camera(camera); });
}

void NffReader::read_background() {
  const glm::dvec3 color = tokens_.triple("the background color");
  add([&] { builder_.set_background(color); });
}

void NffReader::read_light() {
  const glm::dvec3 position = tokens_.triple("the light's position");
  glm::dvec3 color(1.0);
  if (tokens_.at_number()) color = tokens_.triple("the light's color");
  add([&] { builder_.add_light(position, color); });
}

/// `la` is a command of two dialects:
/// - before a name (not a number), it is the position and optional color of a moving light (AFF,
///   the format of Lext, Assarsson and Moeller, "BART: A Benchmark for Animated Ray Tracing", 2001;
///   `parseLight` in its parse.c);
/// - before numbers, it is the corner, two edges and optional color of a rectangular light (in a
///   path tracer, `do_area_light` in its nff2scene, and its Blender exporter, `WriteAreaLamp`).
void NffReader::read_light_of_a_dialect() {
  NffTokens ahead = tokens_;
  std::size_t numbers = 0;
  for (; ahead.at_number(); ++numbers) ahead.take();
  if (numbers == 0 && tokens_.peek().line == command_.line) return read_animated_light();
  if (numbers != 9 && numbers != 12) {
    tokens_.refuse(
        command_.line,
        fmt::format("'la' has {} numbers, but a rectangular light has a corner, two edges and, if "
                    "any, a color (9 or 12 numbers), and a light that moves has a name, then a "
                    "position and, if any, a color; make it 'l' and a position, or remove it",
                    numbers));
  }
  read_area_light();
}

/// NFF scenes are static here, so the light stays at its first position.
void NffReader::read_animated_light() {
  tokens_.take();  // its name
  note(command_.line, "an animated light is read as a static light");
  read_light();
}

/// Lights are points here. The rectangle of an area light shines toward its normal, edge x edge, so
/// the point is slightly on that side of its center: otherwise a ceiling that contains the
/// rectangle could hide it.
void NffReader::read_area_light() {
  constexpr double kOffset = 1e-3;  // of the side of a square of the same area
  const glm::dvec3 corner = tokens_.triple("the area light's corner");
  const glm::dvec3 edge = tokens_.triple("the area light's first edge");
  const glm::dvec3 other_edge = tokens_.triple("the area light's second edge");
  glm::dvec3 color(1.0);
  if (tokens_.at_number()) color = tokens_.triple("the area light's color");
  const glm::dvec3 normal = glm::cross(edge, other_edge);
  const double area = glm::length(normal);
  glm::dvec3 position = corner + 0.5 * (edge + other_edge);
  if (area > 0.0) position += kOffset / std::sqrt(area) * normal;
  note(command_.line, "an area light is read as a point light at its middle",
       "; its shadows have no soft edges, and it is not visible");
  add([&] { builder_.add_light(position, color); });
}

void NffReader::read_surface() {
  if (!tokens_.at_number()) tokens_.number("the color");  // refuses
  read_surface_fields({});
}

void NffReader::read_finish() {
  read_surface_fields(finished_surface(*find_finish(command_.text)));
}

/// Replaces fields of the surface with the numbers given.
void NffReader::read_surface_fields(Surface surface) {
  if (tokens_.at_number()) surface.color = tokens_.triple("the color");
  for (float* field : {&surface.diffuse, &surface.specular, &surface.shine, &surface.transmittance,
                       &surface.refraction_index}) {
    if (!tokens_.at_number()) break;
    *field = tokens_.number("a factor of the surface");
  }
  if (tokens_.at_number()) {
    // "Extensions of the Neutral File Format", 1993 (paulbourke.net/dataformats/nff/enff.html).
    note(command_.line, "the ninth field of a surface, ENFF's ambient factor, is ignored");
    tokens_.number("the ninth field of the surface");
  }
  add([&] { builder_.set_surface(surface); });
}

void NffReader::read_sphere() {
  const glm::dvec3 center = tokens_.triple("the sphere's center");
  const double radius = tokens_.number("the sphere's radius");
  add_primitive([&] { builder_.add_sphere(center, radius); });
}

void NffReader::read_cone() {
  const glm::dvec3 base = tokens_.triple("the cone's base");
  const double base_radius = tokens_.number("the cone's base radius");
  const glm::dvec3 apex = tokens_.triple("the cone's apex");
  const double apex_radius = tokens_.number("the cone's apex radius");
  add_primitive([&] { builder_.add_cone(base, base_radius, apex, apex_radius); });
}

void NffReader::read_corners(bool smooth) {
  const long count = tokens_.integer("the number of vertices");
  if (count < 1) {  // fewer than 3 are degenerate
    tokens_.refuse(command_.line,
                   fmt::format("a polygon of {} vertices; it must have at least 3", count));
  }
  const auto size = static_cast<std::size_t>(count);
  if (size > tokens_.max_numbers_left() / (smooth ? 6 : 3)) {
    tokens_.refuse(command_.line,
                   fmt::format("a polygon of {} vertices, more than the rest of the file can "
                               "hold; is the file cut off?",
                               count));
  }
  std::vector<glm::dvec3> vertices;
  std::vector<glm::dvec3> normals;
  vertices.reserve(size);
  normals.reserve(smooth ? size : 0);
  for (std::size_t i = 0; i < size; ++i) {
    vertices.emplace_back(tokens_.triple("a vertex"));
    if (smooth) normals.emplace_back(tokens_.triple("a normal"));
  }
  const Repairs before = builder_.repairs();
  add_primitive([&] { builder_.add_polygon(vertices, normals); });
  const Repairs& after = builder_.repairs();
  if (after.merged_corners > before.merged_corners) {
    note(command_.line, "a polygon has consecutive corners at the same place, treated as one");
  }
  if (after.replaced_normals > before.replaced_normals) {
    note(command_.line, "a polygon has a normal of length 0; its plane's normal is used instead");
  }
}

}  // namespace

NffResult parse_nff(std::string_view text, const std::string& file, ReadOptions options) {
  return NffReader(text, file, options).read();
}

NffResult read_nff(const std::filesystem::path& path, ReadOptions options) {
  const std::string text = read_text_input(path, kLargestFile);
  try {
    return parse_nff(text, path.string(), options);
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format(
        "{}: out of memory for its primitives; close other programs, or divide the scene",
        path.string()));
  }
}

void register_nff(Catalogue& catalogue) {
  catalogue.add_format(
      {[](std::string_view spec) {
         const std::filesystem::path path(spec);
         return path.extension() == ".nff" || (path.has_parent_path() && !path.has_extension());
       },
       [](std::string_view spec, ReadOptions options, std::vector<std::string>& warnings) {
         NffResult result = read_nff(spec, options);
         warnings = std::move(result.warnings);
         return Animation{std::move(result.scene)};
       }});
}

}  // namespace beambench::scenes::nff
