#include "scenes/formats/nff/nff_view.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace beambench::scenes::nff {
namespace {

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
    // Our own, written in comments (kOwnComment).
    {"name", [](NffTokens& tokens, const NffToken& word,
                Camera& camera) { camera.name = tokens.rest_of_line(word, "the camera's name"); }},
    {"aspect", [](NffTokens& tokens, const NffToken&,
                  Camera& camera) { camera.aspect = tokens.number("the aspect"); }},
}};

}  // namespace

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

}  // namespace beambench::scenes::nff
