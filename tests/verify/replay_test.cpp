// A mismatch can be examined again: its report contains a command that works when pasted.

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "harness/verify/describe.hpp"
#include "harness/verify/differ.hpp"
#include "harness/verify/verify_ray.hpp"
#include "scenes/base/shell_word.hpp"
#include "scenes/catalogue.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::verify {
namespace {

TEST(ShellQuoted, LeavesPlainWordsAlone) {
  EXPECT_EQ(shell_quoted("samet:max_level=6,root=box"), "samet:max_level=6,root=box");
  EXPECT_EQ(shell_quoted("a/b.nff"), "a/b.nff");
}

TEST(ShellQuoted, PreservesEveryCharacter) {
  const TemporaryFolder folder;
  for (const std::string word :
       {"", "two words", "it's", R"($HOME `ls` "x" \ ; & | * ~ #)", "''"}) {
    const std::string command =
        "printf %s " + shell_quoted(word) + " > '" + (folder.path() / "out").string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    EXPECT_EQ(read_text(folder.path() / "out"), word);
  }
}

TEST(ShellQuoted, PreservesUnprintableCharactersInBash) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "out").string();
  for (const std::string word : {"esc\x1B[31m.nff", "C\xE1mara", "it's\n\\x41 \xFF",
                                 "\x07"
                                 "ab"}) {
    const std::string line = "printf %s " + shell_quoted(word) + " > '" + out + "'";
    const std::string script = folder.write("script", line).string();
    ASSERT_EQ(std::system(("bash '" + script + "'").c_str()), 0) << line;
    EXPECT_EQ(read_text(out), word);
  }
}

TEST(ReplayCommand, OpensTheSameFile) {
  const TemporaryFolder folder;
  const std::string file =
      folder
          .write("esc\x1B.nff",
                 "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 8 8\n"
                 "s 0 0 0 1\n")
          .string();
  const scenes::Scene scene = scenes::load_scene(file);
  EXPECT_EQ(scene.name, (folder.path() / "esc\\x1b.nff").string());
  const rays::ImageOfRays image{scene.cameras.front(), {32, 20}, 1};
  const accel::PrimaryRays rays(image.camera, 32, 20, 1);
  const accel::StructureChoice samet = accel::registry().choose(parse_spec("samet"));
  EXPECT_EQ(
      ReplayCommand("beambench", scene, image, samet, rays).of(0),
      "beambench trace " + shell_quoted(file) + " --accel samet --pixel 0,0 --resolution 32x20");
}

TEST(ReplayCommand, NamesOnlyNonDefaultOptions) {
  scenes::Scene scene = scenes::load_scene("tetra:n=1");
  scene.cameras.push_back(scene.cameras.front());
  scene.cameras.back().name = "from the side";
  const accel::StructureChoice samet = accel::registry().choose(parse_spec("samet:max_level=3"));
  const rays::ImageOfRays front{scene.cameras.front(), {32, 20}, 1};
  const accel::PrimaryRays one(front.camera, 32, 20, 1);
  EXPECT_EQ(ReplayCommand("beambench", scene, front, samet, one).of(4 * 32 + 3),
            "beambench trace tetra:n=1 --accel samet:max_level=3 --pixel 3,4 --resolution 32x20");
  const accel::PrimaryRays four(scene.cameras.back(), 32, 20, 4);
  const rays::ImageOfRays side{scene.cameras.back(), {32, 20}, 4};
  EXPECT_EQ(ReplayCommand("beambench", scene, side, samet, four).of((4 * 32 + 3) * 4 + 2),
            "beambench trace tetra:n=1 --accel samet:max_level=3 --pixel 3,4 --resolution 32x20 "
            "--samples 4 --camera 'from the side' --sample 2");
  rays::ImageOfRays typed = front;
  typed.camera.name = "typed";  // none of the scene's
  typed.camera.from = {1.0F, -2.5F, 0.1F};
  typed.camera.angle = 30.0F;
  typed.camera.at = {0.0F, 0.0F, 0.0F};
  typed.camera.up = {0.0F, 1.0F, 0.0F};
  EXPECT_EQ(ReplayCommand("beambench", scene, typed, samet, one).of(0),
            "beambench trace tetra:n=1 --accel samet:max_level=3 --pixel 0,0 --resolution 32x20 "
            "--from 1,-2.5,0.1 --at 0,0,0 --up 0,1,0 --angle 30");
  const rays::TraceInput diffuse =
      rays::make_trace_input(scene, front, rays::parse_ray_choice("diffuse:seed=2"));
  EXPECT_EQ(ReplayCommand("beambench", scene, front, samet, diffuse).of(7),
            "beambench trace tetra:n=1 --accel samet:max_level=3 --rays diffuse:seed=2 --ray 7 "
            "--resolution 32x20");
}

/// Returns the line of a text that begins with `beginning`.
std::string line_of(const std::string& text, const std::string& beginning) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(beginning)) return line;
  }
  return "no line begins with '" + beginning + "' in: " + text;
}

/// A scene whose name a shell would split, with hits that a test corrupts.
class PlantedMismatch : public ::testing::Test {
 protected:
  static constexpr int kSamples = 4;

  PlantedMismatch() {
    folder_.write("it's $one.nff",
                  "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 8 8\n"
                  "f 1 0 0 1 0 0 0 0\ns 0 0 0 1\np 3\n-2 -2 -1\n2 -2 -1\n0 2 -1\n");
    scene_ = scenes::load_scene((folder_.path() / "it's $one.nff").string());
  }

  /// Runs a command as pasted, with the real program on PATH.
  std::string paste(const std::string& command, int expected_exit_code) const {
    const std::string bin = std::filesystem::path(BEAMBENCH_BINARY).parent_path().string();
    const std::string file = (folder_.path() / "out").string();
    const int status =
        std::system(("PATH='" + bin + "':$PATH; " + command + " > '" + file + "' 2>&1").c_str());
    EXPECT_EQ(WEXITSTATUS(status), expected_exit_code) << command << "\n" << read_text(file);
    return read_text(file);
  }

  TemporaryFolder folder_;
  scenes::Scene scene_;
};

TEST_F(PlantedMismatch, IsReplayedByThePastedCommand) {
  const accel::PrimaryRays rays(scene_.cameras.front(), 33, 21, kSamples);
  const ReferenceHits reference(scene_, rays);
  const accel::StructureChoice samet = accel::registry().choose(parse_spec("samet:max_level=3"));
  accel::HitBuffer buffer(33, 21, kSamples);
  samet.build(scene_)->closest_hits(rays, buffer, {});
  const std::size_t lost = buffer.index(16, 10, 3);
  ASSERT_TRUE(buffer.get(lost));
  buffer.set(lost, std::nullopt);

  std::vector<DiffClass> classes(buffer.size());
  const DiffReport report =
      verify_results(reference, buffer, accel::Conformance::kBitExact, classes);
  ASSERT_EQ(report.verdict, Verdict::kMismatch);
  ASSERT_EQ(report.examples.size(), 1U);
  EXPECT_EQ(classes[lost], DiffClass::kStructureError);
  EXPECT_EQ(std::count(classes.begin(), classes.end(), DiffClass::kAgree),
            static_cast<std::ptrdiff_t>(classes.size()) - 1);

  const ReplayCommand replay("beambench", scene_, {scene_.cameras.front(), {33, 21}, kSamples},
                             samet, rays);
  const std::string described = describe(scene_, rays, report.examples[0], replay);
  const std::string pasted = line_of(described, "  replay ").substr(9);
  const std::string shown = paste(pasted, 0);  // the program's own samet does not lose the hit
  EXPECT_EQ(line_of(shown, "  ray "), line_of(described, "  ray "));
  EXPECT_EQ(line_of(shown, "  oracle "), line_of(described, "  oracle "));
  EXPECT_NE(shown.find("pixel (16, 10) sample 3: agree"), std::string::npos) << shown;
  EXPECT_NE(shown.find("leaf"), std::string::npos) << shown;
}

TEST_F(PlantedMismatch, OfASecondaryRayIsReplayedByThePastedCommand) {
  const rays::ImageOfRays image{scene_.cameras.front(), {33, 21}, 1};
  const accel::StructureChoice samet = accel::registry().choose(parse_spec("samet:max_level=3"));
  for (const char* kind : {"random:seed=4", "reflection"}) {
    const ReferenceHits reference(
        scene_, rays::make_trace_input(scene_, image, rays::parse_ray_choice(kind)));
    rays::TraceResults results = rays::make_results(reference.input());
    rays::trace(*samet.build(scene_), reference.input(), results);
    auto& hits = std::get<accel::HitBuffer>(results);
    std::size_t at = 0;
    while (!hits.get(at) && at + 1 < hits.size()) ++at;
    const auto found = hits.get(at);
    hits.set(at, found ? std::nullopt : std::optional(accel::Hit{1.0F, 0}));
    const DiffReport report = verify_results(reference, results, accel::Conformance::kBitExact);
    ASSERT_EQ(report.examples.size(), 1U) << kind;

    const ReplayCommand replay("beambench", scene_, image, samet, reference.input());
    const std::string described = describe(scene_, reference.input(), report.examples[0], replay);
    const std::string shown = paste(line_of(described, "  replay ").substr(9), 0);
    EXPECT_EQ(line_of(shown, "  ray "), line_of(described, "  ray "));
    EXPECT_EQ(line_of(shown, "  oracle "), line_of(described, "  oracle "));
    EXPECT_NE(shown.find("ray " + std::to_string(at) + ": agree"), std::string::npos) << shown;
  }
}

TEST_F(PlantedMismatch, OneRayIsClassifiedAsInItsImage) {
  const accel::PrimaryRays rays(scene_.cameras.front(), 16, 16, 1);
  const ReferenceHits reference(scene_, rays);
  accel::HitBuffer buffer(16, 16, 1);
  accel::registry().choose(parse_spec("exhaustive")).build(scene_)->closest_hits(rays, buffer, {});
  for (std::size_t i = 0; i < buffer.size(); i += 3) {  // lost, moved, invented
    const auto hit = buffer.get(i);
    if (!hit) buffer.set(i, accel::Hit{4.0F, 1});
    if (hit) buffer.set(i, i % 2 == 0 ? std::nullopt : std::optional(accel::Hit{hit->t + 1.0F, 0}));
  }
  for (const accel::Conformance conformance :
       {accel::Conformance::kBitExact, accel::Conformance::kBaseline}) {
    std::vector<DiffClass> classes(buffer.size());
    verify_results(reference, buffer, conformance, classes);
    for (std::size_t i = 0; i < buffer.size(); ++i) {
      Mismatch candidate = candidate_mismatch(rays, buffer, i, reference.hits()[i]);
      verify_ray(scene_, conformance, candidate);
      EXPECT_EQ(candidate.diff_class, classes[i]) << i;
    }
  }
}

}  // namespace
}  // namespace beambench::verify
