// Pins the work of each structure: a structure that gets worse fails here even if its hits stay
// correct. An improvement also fails; then pin the new figures.

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <hwy/detect_targets.h>

#include "accel/core/registry.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::accel {
namespace {

/// Returns the counters without the tests by kind of primitive, which are a breakdown of the tests
/// (tests/accel/expected_visits_test.cpp).
std::map<std::string, std::uint64_t> work_of(const WorkCounters& counters) {
  std::map<std::string, std::uint64_t> work;
  for (const auto& [name, count] : counters.by_name()) {
    if (count != 0 && std::ranges::count(kTestNames, name) == 0) work[name] = count;
  }
  return work;
}

/// The work for 64x64 primary rays.
struct PinnedRow {
  const char* structure;
  const char* scene;
  std::map<std::string, std::uint64_t> work;  ///< counters that are not 0
};

class PinnedWork : public ::testing::TestWithParam<PinnedRow> {};

TEST_P(PinnedWork, IsUnchanged) {
  const PinnedRow& row = GetParam();
  const scenes::Scene scene = scenes::load_scene(row.scene);
  const auto structure = registry().choose(parse_spec(row.structure)).build(scene);
  HitBuffer buffer(64, 64, 1);
  WorkCounters counters;
  structure->closest_hits(PrimaryRays(scene.cameras.front(), 64, 64, 1), buffer, {&counters});
  EXPECT_EQ(work_of(counters), row.work);
}

std::string test_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
  return name;
}

std::string row_name(const ::testing::TestParamInfo<PinnedRow>& info) {
  return test_name(std::string(info.param.structure) + '_' + info.param.scene);
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Structures, PinnedWork, ::testing::Values(
    PinnedRow{"samet", "tetra:n=4", {{"empty_leaves", 17'142}, {"last_climb", 4459}, {"leaves", 22'163}, {"neighbor_steps", 64'398}, {"primitive_tests", 10'665}, {"traversal_steps", 79'395}}},
    PinnedRow{"samet", "balls:n=2", {{"empty_leaves", 20'835}, {"leaves", 36'819}, {"neighbor_steps", 130'031}, {"primitive_tests", 85'609}, {"traversal_steps", 155'896}}},
    PinnedRow{"samet", "escena1", {{"empty_leaves", 16'004}, {"last_climb", 3552}, {"leaves", 26'168}, {"neighbor_steps", 82'127}, {"primitive_tests", 10'726}, {"traversal_steps", 98'455}}},
    PinnedRow{"samet-net", "tetra:n=4", {{"empty_leaves", 17'142}, {"leaves", 22'163}, {"neighbor_steps", 19'683}, {"primitive_tests", 10'665}, {"traversal_steps", 34'680}}},
    PinnedRow{"samet-net", "balls:n=2", {{"empty_leaves", 20'835}, {"leaves", 36'819}, {"neighbor_steps", 32'723}, {"primitive_tests", 85'609}, {"traversal_steps", 58'588}}},
    PinnedRow{"samet-net", "escena1", {{"empty_leaves", 16'004}, {"leaves", 26'168}, {"neighbor_steps", 23'631}, {"primitive_tests", 10'726}, {"traversal_steps", 39'959}}},
    PinnedRow{"glassner", "tetra:n=4", {{"empty_leaves", 17'142}, {"leaves", 22'163}, {"primitive_tests", 10'665}, {"traversal_steps", 112'414}}},
    PinnedRow{"glassner", "balls:n=2", {{"empty_leaves", 20'835}, {"leaves", 36'819}, {"primitive_tests", 85'609}, {"traversal_steps", 210'613}}},
    PinnedRow{"glassner", "escena1", {{"empty_leaves", 16'004}, {"leaves", 26'168}, {"primitive_tests", 10'726}, {"traversal_steps", 152'433}}},
    PinnedRow{"gargantini", "tetra:n=4", {{"empty_leaves", 17'142}, {"leaves", 22'163}, {"primitive_tests", 10'665}, {"traversal_steps", 45'417}}},
    PinnedRow{"gargantini", "balls:n=2", {{"empty_leaves", 20'835}, {"leaves", 36'819}, {"primitive_tests", 85'609}, {"traversal_steps", 90'236}}},
    PinnedRow{"gargantini", "escena1", {{"empty_leaves", 16'004}, {"leaves", 26'168}, {"primitive_tests", 10'726}, {"traversal_steps", 56'667}}},
    PinnedRow{"gargantini:planes=cost", "tetra:n=4", {{"empty_leaves", 13'964}, {"leaves", 18'580}, {"primitive_tests", 9337}, {"traversal_steps", 39'075}}},
    PinnedRow{"gargantini:planes=cost", "balls:n=2", {{"empty_leaves", 43'159}, {"leaves", 52'008}, {"primitive_tests", 10'832}, {"traversal_steps", 100'589}}},
    PinnedRow{"gargantini:planes=cost", "escena1", {{"empty_leaves", 15'544}, {"leaves", 25'260}, {"primitive_tests", 10'024}, {"traversal_steps", 55'484}}},
    PinnedRow{"glassner:planes=cost,build=on-demand", "balls:n=2", {{"empty_leaves", 43'159}, {"leaves", 52'008}, {"primitive_tests", 10'832}, {"traversal_steps", 245'183}}},
    PinnedRow{"voxel-grid", "tetra:n=4", {{"empty_leaves", 12'357}, {"leaves", 18'052}, {"primitive_tests", 26'779}, {"traversal_steps", 18'052}}},
    PinnedRow{"voxel-grid", "balls:n=2", {{"leaves", 12'867}, {"primitive_tests", 195'217}, {"traversal_steps", 12'867}}},
    PinnedRow{"voxel-grid", "escena1", {{"empty_leaves", 1'519}, {"leaves", 12'160}, {"primitive_tests", 18'401}, {"traversal_steps", 12'160}}},
    PinnedRow{"voxel-grid:fill=lazy", "tetra:n=4", {{"empty_leaves", 12'357}, {"leaves", 18'052}, {"primitive_tests", 26'779}, {"traversal_steps", 18'052}}},
    PinnedRow{"voxel-grid:fill=lazy", "balls:n=2", {{"leaves", 12'867}, {"primitive_tests", 195'217}, {"traversal_steps", 12'867}}},
    PinnedRow{"voxel-grid:fill=lazy", "escena1", {{"empty_leaves", 1'519}, {"leaves", 12'160}, {"primitive_tests", 18'401}, {"traversal_steps", 12'160}}},
    PinnedRow{"voxel-grid:mailboxes=true", "tetra:n=4", {{"empty_leaves", 12'357}, {"leaves", 18'052}, {"primitive_tests", 16'744}, {"traversal_steps", 18'052}}},
    PinnedRow{"voxel-grid:mailboxes=true", "balls:n=2", {{"leaves", 12'867}, {"primitive_tests", 170'377}, {"traversal_steps", 12'867}}},
    PinnedRow{"voxel-grid:mailboxes=true", "escena1", {{"empty_leaves", 1'519}, {"leaves", 12'160}, {"primitive_tests", 11'196}, {"traversal_steps", 12'160}}},
    PinnedRow{"voxel-grid:resolution=32", "tetra:n=4", {{"empty_leaves", 51'687}, {"leaves", 56'708}, {"primitive_tests", 10'665}, {"traversal_steps", 56'708}}},
    PinnedRow{"voxel-grid:resolution=32", "balls:n=2", {{"empty_leaves", 94'392}, {"leaves", 123'961}, {"primitive_tests", 92'241}, {"traversal_steps", 123'961}}},
    PinnedRow{"voxel-grid:resolution=32", "escena1", {{"empty_leaves", 20'659}, {"leaves", 30'829}, {"primitive_tests", 10'720}, {"traversal_steps", 30'829}}},
    PinnedRow{"hierarchical-grid:mailboxes=false", "tetra:n=6", {{"empty_leaves", 21'976}, {"leaves", 27'866}, {"primitive_tests", 34'699}, {"traversal_steps", 33'149}}},
    PinnedRow{"hierarchical-grid:mailboxes=false", "balls:n=4", {{"empty_leaves", 46'081}, {"leaves", 63'055}, {"primitive_tests", 51'144}, {"traversal_steps", 73'439}}},
    PinnedRow{"hierarchical-grid:mailboxes=false", "escena2", {{"empty_leaves", 2208}, {"leaves", 5983}, {"primitive_tests", 4113}, {"traversal_steps", 6948}}},
    PinnedRow{"hierarchical-grid:inner=powers", "tetra:n=6", {{"empty_leaves", 22'866}, {"leaves", 28'744}, {"primitive_tests", 25'721}, {"traversal_steps", 33'773}}},
    PinnedRow{"hierarchical-grid:inner=powers", "balls:n=4", {{"empty_leaves", 44'485}, {"leaves", 61'310}, {"primitive_tests", 39'248}, {"traversal_steps", 72'897}}},
    PinnedRow{"hierarchical-grid:inner=powers", "escena2", {{"empty_leaves", 1904}, {"leaves", 5749}, {"primitive_tests", 4015}, {"traversal_steps", 6762}}},
    PinnedRow{"goldsmith-salmon", "tetra:n=6", {{"box_tests", 103'576}, {"primitive_tests", 6'184}, {"traversal_steps", 32'328}}},
    PinnedRow{"goldsmith-salmon", "balls:n=4", {{"box_tests", 84'360}, {"primitive_tests", 5'392}, {"traversal_steps", 29'864}}},
    PinnedRow{"goldsmith-salmon", "escena1", {{"box_tests", 81'281}, {"primitive_tests", 3'579}, {"traversal_steps", 29'116}}},
    PinnedRow{"goldsmith-salmon:order=shuffled", "tetra:n=6", {{"box_tests", 76'474}, {"primitive_tests", 6'184}, {"traversal_steps", 29'080}}},
    PinnedRow{"goldsmith-salmon:order=shuffled", "balls:n=4", {{"box_tests", 101'060}, {"primitive_tests", 5'392}, {"traversal_steps", 39'021}}},
    PinnedRow{"goldsmith-salmon:order=shuffled", "escena1", {{"box_tests", 88'921}, {"primitive_tests", 3'579}, {"traversal_steps", 30'569}}},
    PinnedRow{"goldsmith-salmon:queue=stack", "tetra:n=6", {{"box_tests", 104'116}, {"primitive_tests", 6'304}, {"traversal_steps", 32'532}}},
    PinnedRow{"goldsmith-salmon:queue=stack", "balls:n=4", {{"box_tests", 86'577}, {"primitive_tests", 5'589}, {"traversal_steps", 30'636}}},
    PinnedRow{"goldsmith-salmon:queue=stack", "escena1", {{"box_tests", 81'941}, {"primitive_tests", 3'693}, {"traversal_steps", 29'368}}},
    PinnedRow{"sah-bvh", "tetra:n=6", {{"box_tests", 68'080}, {"confirmed_tests", 1619}, {"leaves", 1'976}, {"primitive_tests", 15'808}, {"traversal_steps", 10'486}}},
    PinnedRow{"sah-bvh", "balls:n=4", {{"box_tests", 102'071}, {"confirmed_tests", 4342}, {"leaves", 6754}, {"primitive_tests", 28'648}, {"traversal_steps", 20'463}}},
    PinnedRow{"sah-bvh", "escena1", {{"box_tests", 58'380}, {"confirmed_tests", 2079}, {"leaves", 5547}, {"primitive_tests", 42'712}, {"traversal_steps", 13'284}}},
    PinnedRow{"sah-bvh:builder=spatial", "tetra:n=6", {{"box_tests", 68'080}, {"confirmed_tests", 1677}, {"leaves", 1'851}, {"primitive_tests", 14'808}, {"traversal_steps", 10'361}}},
    PinnedRow{"sah-bvh:builder=spatial", "balls:n=4", {{"box_tests", 95'977}, {"confirmed_tests", 4663}, {"leaves", 6685}, {"primitive_tests", 34'493}, {"traversal_steps", 19'798}}},
    PinnedRow{"sah-bvh:builder=spatial", "escena1", {{"box_tests", 58'380}, {"confirmed_tests", 2073}, {"leaves", 5560}, {"primitive_tests", 42'566}, {"traversal_steps", 13'297}}},
    PinnedRow{"sah-bvh:builder=lbvh", "balls:n=4", {{"box_tests", 132'098}, {"confirmed_tests", 5027}, {"leaves", 7239}, {"primitive_tests", 29'288}, {"traversal_steps", 24'787}}},
    PinnedRow{"sah-bvh:builder=ploc", "balls:n=4", {{"box_tests", 104'981}, {"confirmed_tests", 4237}, {"leaves", 6465}, {"primitive_tests", 18'585}, {"traversal_steps", 20'529}}},
    PinnedRow{"sah-bvh:builder=sweep", "balls:n=4", {{"box_tests", 101'743}, {"confirmed_tests", 4300}, {"leaves", 7421}, {"primitive_tests", 41'954}, {"traversal_steps", 21'600}}},
    PinnedRow{"sah-bvh:reinsertion=true", "balls:n=4", {{"box_tests", 95'401}, {"confirmed_tests", 4249}, {"leaves", 6453}, {"primitive_tests", 19'107}, {"traversal_steps", 19'139}}},
    PinnedRow{"sah-bvh:builder=spatial,reinsertion=true", "balls:n=4", {{"box_tests", 97'650}, {"confirmed_tests", 4518}, {"leaves", 6368}, {"primitive_tests", 23'355}, {"traversal_steps", 19'394}}},
    PinnedRow{"kd-tree", "tetra:n=6", {{"confirmed_tests", 2031}, {"empty_leaves", 4412}, {"leaves", 8220}, {"primitive_tests", 190'043}, {"traversal_steps", 37'506}}},
    PinnedRow{"kd-tree", "balls:n=4", {{"confirmed_tests", 9704}, {"empty_leaves", 6630}, {"leaves", 18'621}, {"primitive_tests", 240'823}, {"traversal_steps", 77'075}}},
    PinnedRow{"kd-tree", "escena1", {{"confirmed_tests", 2283}, {"empty_leaves", 281}, {"leaves", 3633}, {"primitive_tests", 203'259}, {"traversal_steps", 13'095}}},
    PinnedRow{"kd-tree:builder=median", "tetra:n=6", {{"confirmed_tests", 2221}, {"empty_leaves", 16'095}, {"leaves", 22'045}, {"primitive_tests", 31'818}, {"traversal_steps", 104'686}}},
    PinnedRow{"kd-tree:builder=median", "balls:n=4", {{"confirmed_tests", 8777}, {"empty_leaves", 35'790}, {"leaves", 71'278}, {"primitive_tests", 1'657'914}, {"traversal_steps", 328'526}}},
    PinnedRow{"kd-tree:builder=median", "escena1", {{"confirmed_tests", 2918}, {"empty_leaves", 1175}, {"leaves", 15'684}, {"primitive_tests", 15'059}, {"traversal_steps", 83'455}}},
    PinnedRow{"z-buffer", "tetra:n=6", {{"primitive_tests", 1444}}},
    PinnedRow{"z-buffer", "escena1", {{"primitive_tests", 3411}}},
    PinnedRow{"z-buffer", "closed-room:detail=4", {{"primitive_tests", 5535}}},
    PinnedRow{"polygon-beam", "tetra:n=6", {{"beam_clips", 109'251}, {"beams", 1040}, {"beams_dropped", 829}, {"beams_ended", 711}, {"beams_leaving", 329}, {"beams_made", 1040}, {"leaves", 483}, {"polygons_met", 1286}, {"primitive_tests", 971}, {"samples_in_beams", 767}, {"traversal_steps", 965}}},
    PinnedRow{"polygon-beam", "gears:n=1", {{"beam_clips", 8112}, {"beams", 536}, {"beams_dropped", 523}, {"beams_ended", 502}, {"beams_leaving", 34}, {"beams_made", 536}, {"leaves", 47}, {"polygons_met", 330}, {"primitive_tests", 3736}, {"samples_in_beams", 3724}, {"traversal_steps", 93}}},
    PinnedRow{"polygon-beam", "closed-room:detail=4", {{"beam_clips", 24'553}, {"beams", 1433}, {"beams_dropped", 2008}, {"beams_ended", 1433}, {"beams_made", 1433}, {"leaves", 875}, {"polygons_met", 1550}, {"primitive_tests", 4152}, {"samples_in_beams", 4096}, {"traversal_steps", 1998}}},
    PinnedRow{"tile-beam:backface_culling=true", "tetra:n=6", {{"beams", 1}, {"box_tests", 272}, {"leaves", 256}, {"primitive_tests", 4096}, {"traversal_steps", 273}}},
    PinnedRow{"tile-beam:backface_culling=true", "bumpy:triangles=50700", {{"beams", 1}, {"box_tests", 2362}, {"leaves", 1389}, {"primitive_tests", 30'245}, {"traversal_steps", 1651}}},
    PinnedRow{"tile-beam:backface_culling=true", "soup:triangles=100000", {{"beams", 1}, {"box_tests", 17'824}, {"leaves", 13'301}, {"primitive_tests", 99'983}, {"traversal_steps", 17'812}}},
    PinnedRow{"tile-beam:backface_culling=true", "closed-room:detail=4", {{"beams", 1}, {"box_tests", 346}, {"leaves", 224}, {"primitive_tests", 5083}, {"traversal_steps", 284}}},
    PinnedRow{"tile-beam:backface_culling=false", "bumpy:triangles=50700", {{"beams", 1}, {"box_tests", 2368}, {"leaves", 1695}, {"primitive_tests", 36'114}, {"traversal_steps", 1959}}},
    PinnedRow{"tile-beam:backface_culling=false", "closed-room:detail=4", {{"beams", 1}, {"box_tests", 346}, {"leaves", 247}, {"primitive_tests", 5552}, {"traversal_steps", 307}}}
  ), row_name);
// clang-format on

/// The work of tile-beam's pencils for the rays that follow from 128x128 primary rays. Uses SSE4,
/// which every x86 machine has: other instruction sets multiply and add with one rounding, which
/// changes some comparisons.
struct PencilRow {
  const char* kind;
  const char* scene;
  std::map<std::string, std::uint64_t> work;  ///< counters that are not 0
};

class PinnedPencilWork : public ::testing::TestWithParam<PencilRow> {};

TEST_P(PinnedPencilWork, IsUnchanged) {
  if (!HWY_ARCH_X86) GTEST_SKIP() << "this machine has no SSE4";
  const PencilRow& row = GetParam();
  const scenes::Scene scene = scenes::load_scene(row.scene);
  const auto structure = registry().choose(parse_spec("tile-beam:isa=sse4")).build(scene);
  const auto image = rays::image_of(scene.cameras.front(), rays::Resolution{128, 128}, 1);
  const auto input = rays::make_trace_input(scene, image, rays::parse_ray_choice(row.kind));
  rays::TraceResults results = rays::make_results(input);
  WorkCounters counters;
  rays::trace(*structure, input, results, &counters);
  EXPECT_EQ(work_of(counters), row.work);
}

std::string pencil_row_name(const ::testing::TestParamInfo<PencilRow>& info) {
  return test_name(std::string(info.param.kind) + '_' + info.param.scene);
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(TileBeam, PinnedPencilWork, ::testing::Values(
    PencilRow{"shadow", "teapot:n=3", {{"beams", 11}, {"box_tests", 290}, {"handed_over_rays", 1}, {"leaves", 117}, {"primitive_tests", 85'283}, {"traversal_steps", 165}}},
    PencilRow{"mirror", "teapot:n=3", {{"beams", 6}, {"box_tests", 166}, {"leaves", 68}, {"primitive_tests", 25'240}, {"traversal_steps", 99}}},
    PencilRow{"shadow", "closed-room:detail=4", {{"beams", 25}, {"box_tests", 6657}, {"handed_over_rays", 219}, {"leaves", 908}, {"primitive_tests", 431'579}, {"traversal_steps", 1631}}},
    PencilRow{"mirror", "closed-room:detail=4", {{"beams", 22}, {"box_tests", 138'862}, {"confirmed_tests", 10}, {"handed_over_rays", 63}, {"leaves", 7299}, {"primitive_tests", 337'394}, {"stream_chunks", 1869}, {"stream_lists", 127}, {"stream_packets", 127}, {"stream_rays", 15'619}, {"stream_singles", 728}, {"traversal_steps", 25'062}}},
    PencilRow{"shadow", "balls:n=2", {{"beams", 22}, {"box_tests", 164}, {"leaves", 104}, {"primitive_tests", 81'216}, {"traversal_steps", 142}}}
  ), pencil_row_name);
// clang-format on

}  // namespace
}  // namespace beambench::accel
