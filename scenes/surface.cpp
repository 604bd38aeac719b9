#include "scenes/surface.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace beambench::scenes {
namespace {

struct FinishEntry {
  std::string_view word;
  Surface surface;
};

/// The finishes, indexed by `Finish`: the word, then color, diffuse, specular, shine,
/// transmittance, index.
constexpr std::array<FinishEntry, 13> kFinishes = {{
    {"f", {}},
    {"surfreflect", {{1.0F, 1.0F, 1.0F}, 0.1F, 0.9F, 200, 0, 1, Finish::kReflect}},
    {"surfglass", {{1.0F, 1.0F, 1.0F}, 0.1F, 0.1F, 200, 0.9F, 1.5F, Finish::kGlass}},
    {"surfgranite", {{0.6F, 0.57F, 0.55F}, 0.8F, 0.2F, 20, 0, 1, Finish::kGranite}},
    {"surfshiny", {{0.9F, 0.9F, 0.9F}, 0.6F, 0.4F, 60, 0, 1, Finish::kShiny}},
    {"texblackmarble", {{0.1F, 0.1F, 0.11F}, 0.7F, 0.3F, 50, 0, 1, Finish::kBlackMarble}},
    {"texbluemarble", {{0.3F, 0.38F, 0.62F}, 0.7F, 0.3F, 50, 0, 1, Finish::kBlueMarble}},
    {"texcherrywood", {{0.55F, 0.27F, 0.16F}, 0.9F, 0.1F, 15, 0, 1, Finish::kCherryWood}},
    {"texclouds", {{0.65F, 0.77F, 0.95F}, 1, 0, 0, 0, 1, Finish::kClouds}},
    {"texdarkwood", {{0.3F, 0.18F, 0.1F}, 0.9F, 0.1F, 15, 0, 1, Finish::kDarkWood}},
    {"texpinewood", {{0.85F, 0.65F, 0.4F}, 0.9F, 0.1F, 15, 0, 1, Finish::kPineWood}},
    {"texredmarble", {{0.62F, 0.22F, 0.18F}, 0.7F, 0.3F, 50, 0, 1, Finish::kRedMarble}},
    {"texwhitemarble", {{0.9F, 0.9F, 0.88F}, 0.7F, 0.3F, 50, 0, 1, Finish::kWhiteMarble}},
}};

const FinishEntry& entry_of(Finish finish) { return kFinishes[static_cast<std::size_t>(finish)]; }

}  // namespace

std::string_view finish_word(Finish finish) { return entry_of(finish).word; }

std::optional<Finish> find_finish(std::string_view word) {
  const auto* const entry = std::find_if(kFinishes.begin() + 1, kFinishes.end(),
                                         [&](const FinishEntry& e) { return e.word == word; });
  if (entry == kFinishes.end()) return std::nullopt;
  return entry->surface.finish;
}

Surface finished_surface(Finish finish) { return entry_of(finish).surface; }

}  // namespace beambench::scenes
