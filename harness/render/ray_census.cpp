#include "harness/render/ray_census.hpp"

#include <algorithm>
#include <array>

namespace beambench::render {
namespace {

constexpr std::array<PublishedCounts, 7> kCounts{{
    {"balls:n=4", 263'169, 175'095, 0, 954'368},
    {"gears:n=4", 245'086, 304'643, 207'564, 2'246'955},
    {"mount:n=6", 173'125, 354'769, 354'769, 412'922},
    {"rings:n=7", 263'169, 315'236, 0, 1'085'002},
    {"teapot:n=12", 161'120, 225'248, 0, 407'656},
    {"tetra:n=6", 49'788, 0, 0, 46'112},
    {"tree:n=11", 169'836, 0, 0, 1'097'419},
}};

}  // namespace

std::span<const PublishedCounts> published_spd_counts() { return kCounts; }

const PublishedCounts* find_published_counts(std::string_view scene) {
  const auto* const found = std::ranges::find(kCounts, scene, &PublishedCounts::scene);
  return found == kCounts.end() ? nullptr : found;
}

}  // namespace beambench::render
