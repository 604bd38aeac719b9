// The record of a run: statistics, names, fingerprints, the machine.

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "harness/measure/record/cell_record.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/measure/record/manifest.hpp"
#include "harness/measure/record/robust_statistics.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/camera.hpp"
#include "tests/measure/some_cell.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::measure {
namespace {

TEST(Statistics, MedianIsTheMiddle) {
  EXPECT_EQ(median(std::vector{3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median(std::vector{4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_EQ(median(std::vector{7.0}), 7.0);
}

TEST(Statistics, OneOutlierChangesNothing) {
  const std::vector<double> calm{10.0, 11.0, 12.0, 13.0, 14.0};
  const std::vector<double> disturbed{10.0, 11.0, 12.0, 13.0, 1e6};
  EXPECT_EQ(median(disturbed), median(calm));
  EXPECT_EQ(median_absolute_deviation(disturbed), median_absolute_deviation(calm));
  EXPECT_EQ(minimum(disturbed), 10.0);
}

TEST(Statistics, IntervalHasTheTabulatedRanks) {
  // Ranks of the 95% interval of the median (Conover, table A3): n -> lower rank.
  const std::vector<std::pair<int, int>> table{{6, 1},   {8, 1},   {9, 2},   {11, 2}, {12, 3},
                                               {15, 4},  {17, 5},  {20, 6},  {25, 8}, {30, 10},
                                               {40, 14}, {50, 18}, {100, 40}};
  for (const auto& [n, rank] : table) {
    std::vector<double> samples(static_cast<std::size_t>(n));
    std::iota(samples.begin(), samples.end(), 1.0);
    const auto interval = median_interval(samples);
    ASSERT_TRUE(interval) << n;
    EXPECT_EQ(interval->low, rank) << n;
    EXPECT_EQ(interval->high, n + 1 - rank) << n;
  }
}

TEST(Statistics, FewerThanSixSamplesHaveNoInterval) {
  EXPECT_FALSE(median_interval(std::vector{1.0, 2.0, 3.0, 4.0, 5.0}));
  EXPECT_FALSE(median_interval({}));
}

TEST(Statistics, IntervalCoversTheMedianOfASkewedDistribution) {
  std::mt19937_64 engine(1);
  std::exponential_distribution<double> distribution(1.0);
  const double true_median = std::log(2.0);
  int covered = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> samples(21);
    std::generate(samples.begin(), samples.end(), [&] { return distribution(engine); });
    const auto interval = median_interval(samples);
    covered += interval->low <= true_median && true_median <= interval->high ? 1 : 0;
  }
  EXPECT_GT(covered, kTrials * 94 / 100);
  EXPECT_LT(covered, kTrials * 99 / 100);  // an unbounded interval would be useless
}

TEST(Statistics, TheSpreadOfTheMinimumExtendsToTheFifthOfFifteen) {
  std::vector<double> samples{16, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 1};
  EXPECT_EQ(repeat_spread_of_minimum(samples), 5.0)
      << "6 - 1: another minimum exceeds it with a probability of 2.1%";
  samples.resize(9);
  EXPECT_EQ(repeat_spread_of_minimum(samples), 4.0) << "12 - 8: 1.5%";
  EXPECT_EQ(repeat_spread_of_minimum(std::vector<double>{3, 4, 1, 9}), 8.0) << "1 of 70";
  EXPECT_FALSE(repeat_spread_of_minimum(std::vector<double>{1, 2, 3})) << "1 of 20 is too often";
  EXPECT_FALSE(repeat_spread_of_minimum({}));
}

TEST(Statistics, SpreadOfTheMinimumCoversTheNextMinimum) {
  // The machine disturbs six of ten repetitions, by up to 60%; the others differ by up to 1%.
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto sample = [&] {
    const double time = 100.0 + uniform(engine);
    return uniform(engine) < 0.6 ? time * (1.0 + 0.6 * uniform(engine)) : time;
  };
  constexpr int kTrials = 4000;
  for (const std::size_t n : {6U, 9U, 15U, 40U}) {
    int covered = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<double> samples(n);
      std::vector<double> again(n);
      std::generate(samples.begin(), samples.end(), sample);
      std::generate(again.begin(), again.end(), sample);
      const double change = minimum(again) - minimum(samples);
      covered += std::abs(change) <= *repeat_spread_of_minimum(samples) ? 1 : 0;
    }
    EXPECT_GT(covered, kTrials * 94 / 100) << n;
    EXPECT_LT(covered, kTrials * 995 / 1000) << n;
  }
}

TEST(CellId, KeysDifferWhereCellsDo) {
  const CellId id = some_cell().id;
  CellId other = id;
  other.samples = 4;
  EXPECT_NE(id.key(), other.key());
  EXPECT_EQ(id.name(), "tetra:n=2/default/32x20/1/primary/samet:max_level=6");
  EXPECT_EQ(id.key().size(), 16U);
}

TEST(Fingerprint, DiffersWhereRaysOrHitsDo) {
  const scenes::Camera camera;
  scenes::Camera other = camera;
  other.angle = 45.001F;
  EXPECT_EQ(rays::fingerprint(accel::PrimaryRays(camera, 8, 8, 1)),
            rays::fingerprint(accel::PrimaryRays(camera, 8, 8, 1)));
  EXPECT_NE(rays::fingerprint(accel::PrimaryRays(camera, 8, 8, 1)),
            rays::fingerprint(accel::PrimaryRays(other, 8, 8, 1)));
  accel::HitBuffer one(8, 8, 1);
  accel::HitBuffer two(8, 8, 1);
  EXPECT_EQ(rays::fingerprint(one), rays::fingerprint(two));
  two.set(63, accel::Hit{1.0F, 5});
  EXPECT_NE(rays::fingerprint(one), rays::fingerprint(two));
  one.set(63, accel::Hit{1.0F, 6});
  EXPECT_NE(rays::fingerprint(one), rays::fingerprint(two));
}

TEST(Machine, DisturbancesAreReportedInPlainWords) {
  Machine machine{};
  machine.governor = "performance";
  machine.turbo = "off";
  EXPECT_TRUE(disturbances(machine).empty());
  machine.governor = "powersave";
  machine.turbo = "on";
  machine.virtual_machine = true;
  machine.huge_pages = "always";
  EXPECT_EQ(disturbances(machine).size(), 4U);
}

TEST(Preflight, ShowsTheMachineAndEachWarning) {
  Manifest manifest;
  manifest.machine.cpu = "Some CPU";
  manifest.measurement.pinned_core = 3;
  manifest.measurement.control_word = 0x9fc0;
  manifest.measurement.noise = 0.125;
  manifest.measurement.other_work = 0.25;
  manifest.measurement.hardware_problem = "None.";
  manifest.uncontrolled = {"The clock is wild."};
  const std::vector<std::string> lines = preflight(manifest);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_TRUE(scenes::says(lines[0], {"Some CPU", "core 3", "MXCSR 0x9fc0"}));
  EXPECT_TRUE(scenes::says(lines[1], {"governor unknown", "other work 0.25 processors",
                                      "noise 12.5%", "hardware counters no"}));
  EXPECT_EQ(lines[2], "warning: The clock is wild.");
  EXPECT_TRUE(scenes::says(noise_warning(0.125).value_or(""), {"disturbed", "12%"}));
  EXPECT_FALSE(noise_warning(0.01));
  EXPECT_FALSE(noise_warning(std::nullopt));
}

/// Returns the text that Linux writes for a machine with two cores.
std::string cpuinfo(std::string_view maker, int model, double mhz) {
  const std::string core = fmt::format(
      "vendor_id\t: {}\ncpu family\t: 6\nmodel\t\t: {}\nmodel name\t: Processor\n"
      "stepping\t: 3\ncpu MHz\t\t: {}\nflags\t\t: fpu sse\n",
      maker, model, mhz);
  return fmt::format("processor\t: 0\n{0}\nprocessor\t: 1\n{0}\n", core);
}

TEST(Machine, ProcessorsWithTheSameNameAreDistinguishedByMakerAndModel) {
  const std::string xeon = processor_identity(cpuinfo("GenuineIntel", 143, 2000));
  EXPECT_EQ(xeon,
            "vendor_id\t: GenuineIntel\ncpu family\t: 6\nmodel\t\t: 143\n"
            "model name\t: Processor\nstepping\t: 3\n");
  EXPECT_EQ(xeon, processor_identity(cpuinfo("GenuineIntel", 143, 2750.5)))
      << "its clock changes from minute to minute";
  EXPECT_NE(xeon, processor_identity(cpuinfo("AuthenticAMD", 143, 2000)));
  EXPECT_NE(xeon, processor_identity(cpuinfo("GenuineIntel", 106, 2000)));
  EXPECT_EQ(processor_identity("CPU implementer\t: 0x41\nCPU part\t: 0xd0c\nBogoMIPS\t: 50\n"),
            "CPU implementer\t: 0x41\nCPU part\t: 0xd0c\n");
  EXPECT_EQ(processor_identity(""), "");
}

TEST(Machine, TheIdIdentifiesProcessorAndInstallation) {
  const std::string id = machine_id("xeon", "3d1219c7");
  EXPECT_EQ(id.size(), 16U);
  EXPECT_EQ(id, machine_id("xeon", "3d1219c7"));
  EXPECT_NE(id, machine_id("epyc", "3d1219c7")) << "a cloned system on another processor";
  EXPECT_NE(id, machine_id("xeon", "0e24aa01")) << "two machines of one make";
  EXPECT_NE(machine_id("ab", "c"), machine_id("a", "bc"));
}

TEST(Machine, ReportsWhatItCan) {
  const Machine machine = inspect_machine();
  EXPECT_EQ(machine.id.size(), 16U);
  EXPECT_GE(machine.cores, 1U);
  EXPECT_GT(machine.memory_bytes, 0U);
  EXPECT_GE(machine.page_bytes, 4096U);
  EXPECT_NE(machine.instructions, "");
  EXPECT_NE(machine.executable_hash, rays::fingerprint(std::string_view()));
  EXPECT_EQ(utc_now().size(), std::string_view("2024-05-31T14:07:09Z").size());
}

}  // namespace
}  // namespace beambench::measure
