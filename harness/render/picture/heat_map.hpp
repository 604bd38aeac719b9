#pragma once
// A picture of numbers: a color for each pixel's value, and a legend.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/render/picture/image.hpp"

namespace beambench::render {

/// Values >= 0, one for each pixel, row by row from the top left.
struct HeatMap {
  std::string title;  ///< what the values are, "traversal_steps per ray"
  int width;
  int height;
  std::vector<float> values;
};

/// The value that gets the brightest color: the quantile of 99.5%, so that a few rays that had far
/// more work than all others do not darken these. At least the smallest value > 0.
float brightest_value(const HeatMap& map);

/// Colors from 0 to the brightest value, without a legend.
Image draw_heat_map(const HeatMap& map);

/// The same above a legend: title, mean and maximum, and a bar with numbers; a plus behind the last
/// means that larger values share its color. The picture is widened where it is narrower than its
/// legend.
Image draw_heat_map_with_legend(const HeatMap& map);

/// The numbers written under a bar from 0 to `maximum` > 0: multiples of 1, 2 or 5 times a power of
/// ten, from 0 on, `at_most` of them or fewer.
std::vector<double> legend_ticks(double maximum, int at_most);

}  // namespace beambench::render
