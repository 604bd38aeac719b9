#pragma once
// What `beambench census` finds out, as text and as JSON.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/render/ray_census.hpp"

namespace beambench::cli {

/// The same picture with no ray left out for being faint, to tell what that saves and costs.
struct FullPicture {
  std::uint64_t rays;
  double picture_ms;
  double error;  ///< of the picture with rays left out: `root_mean_square_error`
};

/// What one scene took.
struct CensusResult {
  std::string scene;
  std::size_t lights;
  render::RayCensus census;
  double build_ms;
  double eye_ms;
  double preparation_ms;  ///< light buffers
  double picture_ms;      ///< all but the eye's rays
  std::size_t shadow_bytes;
  std::optional<FullPicture> full;  ///< where rays may have been left out
};

/// A table with a row for each scene.
std::string census_text(const std::vector<CensusResult>& results);

/// Of the scenes whose counts Haines published: each count beside his, and their difference. One
/// above 2% gets a remark: `departure` where the request departs from his rules ("depth 3"), else
/// that it is unexplained. Empty where none of the scenes is among his.
std::string published_text(const std::vector<CensusResult>& results, const std::string& departure);

nlohmann::ordered_json to_json(const CensusResult& result);

/// The same with "published": a count of his, ours and the difference in percent by kind of ray.
nlohmann::ordered_json to_json_beside_published(const CensusResult& result);

}  // namespace beambench::cli
