#include "scenes/nff_reader.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "scenes/error.hpp"
#include "scenes/nff_tokens.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench {
namespace {

/// Reads one file, command by command, into a builder.
class NffReader {
 public:
  NffReader(std::string_view text, const std::string& file) : tokens_(text, file), builder_(file) {}

  NffResult read() &&;

 private:
  struct Command {
    std::string_view word;
    void (NffReader::*read)();
  };
  static const std::array<Command, 8> kCommands;
  const Command* next_command() const;
  void skip_unknown();

  void read_view();
  void read_view_word(std::string_view word, Camera& camera);
  void read_background();
  void read_light();
  void read_surface();
  void read_sphere();
  void read_cone();
  void read_polygon() { read_corners(false); }
  void read_smooth_polygon() { read_corners(true); }
  void read_corners(bool smooth);

  glm::dvec3 triple(std::string_view what) {
    return {tokens_.number(what), tokens_.number(what), tokens_.number(what)};
  }
  float single(std::string_view what) { return static_cast<float>(tokens_.number(what)); }

  /// Runs a call of the builder and puts file and line of the command before its complaints.
  template <typename Add>
  void add(Add call) {
    try {
      call();
    } catch (const InputError& error) {
      tokens_.refuse(line_, error.what());
    }
  }

  NffTokens tokens_;
  SceneBuilder builder_;
  std::vector<std::string> warnings_;
  std::size_t line_ = 1;      // of the command being read
  bool any_command_ = false;  // what precedes the first command may be the header of an e-mail
  std::size_t view_count_ = 0;
};

const std::array<NffReader::Command, 8> NffReader::kCommands = {{
    {"p", &NffReader::read_polygon},
    {"pp", &NffReader::read_smooth_polygon},
    {"s", &NffReader::read_sphere},
    {"c", &NffReader::read_cone},
    {"f", &NffReader::read_surface},
    {"l", &NffReader::read_light},
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
    const Command* command = next_command();
    if (command == nullptr) {
      skip_unknown();
      continue;
    }
    any_command_ = true;
    line_ = tokens_.take().line;
    (this->*command->read)();
  }
  if (!any_command_) {
    tokens_.refuse(1, "there is no NFF command (v, b, l, f, s, c, p or pp) in the file");
  }
  return {std::move(builder_).build(), std::move(warnings_)};
}

const NffReader::Command* NffReader::next_command() const {
  const NffToken& token = tokens_.peek();
  if (!token.starts_line) return nullptr;
  const auto command = std::find_if(kCommands.begin(), kCommands.end(),
                                    [&](const Command& c) { return c.word == token.text; });
  return command == kCommands.end() ? nullptr : &*command;
}

void NffReader::skip_unknown() {
  const NffToken unknown = tokens_.peek();
  if (any_command_ && tokens_.at_number()) {
    tokens_.refuse(unknown.line, fmt::format("the number '{}' stands where a command should; the "
                                             "command at line {} takes fewer numbers",
                                             unknown.text, line_));
  }
  while (!tokens_.at_end() && next_command() == nullptr) tokens_.take();
  const std::string end =
      tokens_.at_end() ? "the end of the file" : fmt::format("line {}", tokens_.peek().line);
  warnings_.push_back(tokens_.located(
      unknown.line, fmt::format("unknown word '{}', skipped up to {}", unknown.text, end)));
}

void NffReader::read_view() {
  static constexpr std::array<std::string_view, 6> kWords = {"from",  "at",         "up",
                                                             "angle", "resolution", "hither"};
  constexpr std::size_t kRequired = 5;
  std::array<bool, kWords.size()> seen{};
  Camera camera;
  if (view_count_++ > 0) camera.name = fmt::format("view {}", view_count_);
  while (true) {
    const auto word = std::find(kWords.begin(), kWords.end(), tokens_.peek().text);
    if (word == kWords.end()) break;
    seen[static_cast<std::size_t>(word - kWords.begin())] = true;
    tokens_.take();
    read_view_word(*word, camera);
  }
  for (std::size_t i = 0; i < kRequired; ++i) {
    if (!seen[i]) {
      tokens_.refuse(line_, fmt::format("the view has no '{}'; v takes from, at, up, angle, hither "
                                        "and resolution, each on a line",
                                        kWords[i]));
    }
  }
  add([&] { builder_.add_camera(camera); });
}

void NffReader::read_view_word(std::string_view word, Camera& camera) {
  if (word == "from") {
    camera.from = triple("the eye");
  } else if (word == "at") {
    camera.at = triple("the point looked at");
  } else if (word == "up") {
    camera.up = triple("the up vector");
  } else if (word == "angle") {
    camera.angle = single("the angle");
  } else if (word == "hither") {
    camera.hither = single("the hither distance");
  } else {
    camera.width = static_cast<int>(tokens_.integer("the width in pixels"));
    camera.height = static_cast<int>(tokens_.integer("the height in pixels"));
  }
}

void NffReader::read_background() {
  const glm::dvec3 color = triple("the background colour");
  add([&] { builder_.set_background(color); });
}

void NffReader::read_light() {
  const glm::dvec3 position = triple("the light's position");
  glm::dvec3 color(1.0);
  if (tokens_.at_number()) color = triple("the light's colour");
  add([&] { builder_.add_light(position, color); });
}

void NffReader::read_surface() {
  Surface surface;
  surface.color = triple("the colour");
  for (float* field : {&surface.diffuse, &surface.specular, &surface.shine, &surface.transmittance,
                       &surface.refraction_index}) {
    if (!tokens_.at_number()) break;
    *field = single("a factor of the surface");
  }
  if (tokens_.at_number()) single("the ninth field of the surface");  // of no known meaning
  add([&] { builder_.set_surface(surface); });
}

void NffReader::read_sphere() {
  const glm::dvec3 center = triple("the sphere's centre");
  const double radius = tokens_.number("the sphere's radius");
  add([&] { builder_.add_sphere(center, radius); });
}

void NffReader::read_cone() {
  const glm::dvec3 base = triple("the cone's base");
  const double base_radius = tokens_.number("the cone's base radius");
  const glm::dvec3 apex = triple("the cone's apex");
  const double apex_radius = tokens_.number("the cone's apex radius");
  add([&] { builder_.add_cone(base, base_radius, apex, apex_radius); });
}

void NffReader::read_corners(bool smooth) {
  const long count = tokens_.integer("the number of vertices");
  if (count < 3) {
    tokens_.refuse(line_, fmt::format("a polygon of {} vertices; it must have at least 3", count));
  }
  const auto size = static_cast<std::size_t>(count);
  if (size > tokens_.most_numbers_left() / (smooth ? 6 : 3)) {
    tokens_.refuse(line_,
                   fmt::format("a polygon of {} vertices, more than the rest of the file can "
                               "hold; is the file cut off?",
                               count));
  }
  std::vector<glm::dvec3> vertices;
  std::vector<glm::dvec3> normals;
  vertices.reserve(size);
  normals.reserve(smooth ? size : 0);
  for (std::size_t i = 0; i < size; ++i) {
    vertices.push_back(triple("a vertex"));
    if (smooth) normals.push_back(triple("a normal"));
  }
  add([&] { builder_.add_polygon(vertices, normals); });
}

}  // namespace

NffResult parse_nff(std::string_view text, const std::string& file) {
  return NffReader(text, file).read();
}

NffResult read_nff(const std::filesystem::path& path) {
  const std::string file = path.string();
  if (std::filesystem::is_directory(path)) {
    throw InputError(file + ": this is a folder; name an NFF file in it");
  }
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (stream && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (!stream.is_open() || stream.bad() || text.bad()) {
    throw InputError(fmt::format("{}: the file cannot be read ({}); check the path", file,
                                 std::generic_category().message(errno)));
  }
  return parse_nff(text.view(), file);
}

}  // namespace beambench
