// Object-space sampling, in which the leaf determines the number of samples of a pixel.

#include "accel/beam/object_space_sampling.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "scenes/catalogue.hpp"

namespace beambench::accel {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

class ObjectSpaceSampling : public ::testing::Test {
 protected:
  ObjectSpaceSampling() { tracer_.closest_hits(rays_, all_, {}); }

  beam::SparseSamples sampled(double few, double many) const {
    return beam::trace_object_space(tracer_, rays_, {few, many});
  }

  scenes::Scene scene_ = scenes::load_scene("delfines");
  beam::BeamTracer tracer_{scene_, beam::BeamOptions{}};
  PrimaryRays rays_{scene_.cameras.front(), 80, 64, 25};
  HitBuffer all_{80, 64, 25};
};

TEST_F(ObjectSpaceSampling, SamplesThatWereTakenHitWhatUniformSamplesHit) {
  const beam::SparseSamples some = sampled(0.1, 0.5);
  std::size_t others = 0;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (some.number[i] != 0) {
      ASSERT_EQ(some.hits.get(i), all_.get(i)) << i;
    } else {
      others += all_.get(i) ? 1 : 0;
      ASSERT_FALSE(some.hits.get(i));
    }
  }
  EXPECT_GT(some.taken(), 0U);
  EXPECT_GT(others, 0U) << "everything was sampled";
}

TEST_F(ObjectSpaceSampling, NoHitIsMissingIfAllLeavesTakeAllSamples) {
  EXPECT_EQ(sampled(0.0, 0.0).hits, all_);
}

TEST_F(ObjectSpaceSampling, NumbersMatchTheirPatterns) {
  const beam::SparseSamples some = sampled(1.0, 4.0);
  std::array<std::size_t, 26> of_number{};
  for (std::size_t i = 0; i < some.number.size(); ++i) {
    const int number = some.number[i];
    if (number == 0) continue;
    const auto pattern = beam::chosen_samples(number);
    ASSERT_NE(std::ranges::find(pattern, static_cast<int>(i % 25)), pattern.end()) << number;
    ++of_number[static_cast<std::size_t>(number)];
  }
  for (const int number : beam::kSampleNumbers) {
    EXPECT_GT(of_number[static_cast<std::size_t>(number)], 0U) << number;
  }
}

TEST_F(ObjectSpaceSampling, LowerThresholdsTakeMoreSamples) {
  const std::size_t least = sampled(kNever, kNever).taken();
  const std::size_t some = sampled(0.2, 1.0).taken();
  const std::size_t more = sampled(0.1, 0.3).taken();
  EXPECT_LT(least, some);
  EXPECT_LT(some, more);
  EXPECT_LE(least, 80U * 64U) << "at most one per pixel";
}

TEST_F(ObjectSpaceSampling, OnlyImagesOf25SamplesAreAccepted) {
  const PrimaryRays five(scene_.cameras.front(), 8, 8, 5);
  EXPECT_THROW(beam::trace_object_space(tracer_, five, {}), std::invalid_argument);
}

TEST(ChosenSamples, SpreadOverTheGrid) {
  for (const int number : beam::kSampleNumbers) {
    EXPECT_EQ(beam::chosen_samples(number).size(), static_cast<std::size_t>(number));
  }
  EXPECT_EQ(beam::chosen_samples(1).front(), 12) << "the middle of 5 x 5";
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  for (const int sample : beam::chosen_samples(5)) {
    rows |= 1U << (sample / 5);
    columns |= 1U << (sample % 5);
  }
  EXPECT_EQ(rows, 31U);
  EXPECT_EQ(columns, 31U);
}

}  // namespace
}  // namespace beambench::accel
