// beambench fingerprint: hashes of scenes, rays and hits that should be equal on every machine.

#include "harness/rays/fingerprint.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/App.hpp>
#include <fmt/format.h>

#include "accel/core/instruction_set.hpp"
#include "accel/core/registry.hpp"
#include "harness/base/messages.hpp"
#include "harness/base/progress.hpp"
#include "harness/cli/commands.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::cli {
namespace {

/// A late frame of animated scenes, all of whose coordinates differ from those of the first frame.
constexpr int kFrame = 7;

/// Scenes that exhaustive search traces in a fraction of a second. They have every kind of
/// primitive, mirrors, glass, and every kind of motion.
constexpr std::array kTraced{"balls:n=2",
                             "closed-room:detail=2",
                             "escena1",
                             "escena2",
                             "finishes",
                             "gears:n=1",
                             "jacks:n=2",
                             "lattice:n=4",
                             "mount:n=4",
                             "prism:detail=2",
                             "rings:n=2",
                             "shells:n=2",
                             "soup:triangles=600",
                             "teapot:n=3",
                             "tetera",
                             "tetra:n=4",
                             "tree:n=7",
                             "exploding-mesh:triangles=400,parts=9@7",
                             "falling-spheres@7",
                             "turning-solids:detail=2,solids=9@7",
                             "twisting-body:triangles=600@7",
                             "waving-sheet:triangles=600@7"};

constexpr std::array kRays{"primary", "shadow",       "area:samples=2", "reflection", "mirror",
                           "diffuse", "ao:samples=2", "path:bounces=2", "random"};

constexpr rays::Resolution kResolution{64, 48};

/// A structure over one of the scenes.
struct Built {
  const accel::StructureChoice* choice;
  std::unique_ptr<accel::Accelerator> structure;
};

/// The closest hits of a structure with its own arithmetic, compared with those of `exhaustive`.
struct Tolerance {
  std::size_t rays = 0;
  std::size_t other_primitive = 0;
  std::size_t other_t = 0;  ///< hits of the same primitive with other bits of t
};

class Fingerprint {
 public:
  /// Adds a line of fields, which are separated by tabs.
  template <class... Fields>
  void add(std::string_view kind, const Fields&... fields) {
    text_ += kind;
    (fmt::format_to(std::back_inserter(text_), "\t{}", fields), ...);
    text_ += '\n';
  }
  /// Adds the hash of all lines, then the values that differ between instruction sets.
  void finish() {
    add("all", rays::hex_digits(rays::fingerprint(text_)));
    for (const auto& [structure, sum] : tolerances) {
      add("tolerance", structure, sum.rays, sum.other_primitive, sum.other_t);
    }
  }
  const std::string& text() const { return text_; }

  /// Whether any structure has returned hits that differ from those of `exhaustive`.
  bool differs = false;
  std::map<std::string, Tolerance> tolerances;

 private:
  std::string text_;
};

void add_scenes(Fingerprint& result, base::Progress& progress) {
  for (const scenes::SceneInfo& info : scenes::scene_catalogue()) {
    if (!info.origin.empty()) continue;
    progress.start(info.name);
    scenes::Animation animation = scenes::load_animation(info.name);
    const auto add = [&](const std::string& name) {
      result.add("scene", name, rays::hex_digits(scenes::scene_hash(animation.scene)));
    };
    add(info.name);
    if (animation.frames > kFrame) {
      scenes::show_frame(animation, kFrame);
      add(fmt::format("{}@{}", info.name, kFrame));
    }
    progress.finish("ok");
  }
}

/// Returns the results of a structure; any that it leaves unwritten differ from every hit.
rays::TraceResults traced(const accel::Accelerator& structure, const rays::TraceInput& input) {
  rays::TraceResults results = rays::make_results(input);
  rays::poison(results);
  rays::trace(structure, input, results);
  return results;
}

void compare(const rays::TraceResults& results, const rays::TraceResults& expected,
             Tolerance& sum) {
  const auto* own = std::get_if<accel::HitBuffer>(&results);
  if (own == nullptr) return;
  const auto& exact = std::get<accel::HitBuffer>(expected);
  sum.rays += own->size();
  for (std::size_t i = 0; i < own->size(); ++i) {
    if (own->primitive()[i] != exact.primitive()[i]) {
      ++sum.other_primitive;
    } else if (std::bit_cast<std::uint32_t>(own->t()[i]) !=
               std::bit_cast<std::uint32_t>(exact.t()[i])) {
      ++sum.other_t;
    }
  }
}

void add_view(Fingerprint& result, std::string_view scene, const rays::TraceInput& input,
              const Built& exhaustive, const std::vector<Built>& others) {
  const rays::TraceResults expected = traced(*exhaustive.structure, input);
  const std::uint64_t hash = rays::fingerprint(expected);
  result.add("view", scene, input.label(), rays::hex_digits(rays::fingerprint(input)),
             rays::hex_digits(hash));
  for (const Built& other : others) {
    if (!rays::is_supported(*other.choice, input)) continue;
    const rays::TraceResults results = traced(*other.structure, input);
    const accel::StructureInfo& info = other.choice->info();
    if (info.conformance != accel::Conformance::kBitExact) {
      compare(results, expected, result.tolerances[info.name]);
    } else if (const std::uint64_t own = rays::fingerprint(results); own != hash) {
      result.add("differs", scene, input.label(), info.name, rays::hex_digits(own));
      result.differs = true;
    }
  }
}

/// Returns the structures to compare with `exhaustive`. Excludes Embree, a library of the system
/// whose versions differ in the last bits of t.
std::vector<accel::StructureChoice> compared_structures() {
  std::vector<accel::StructureChoice> choices;
  for (const accel::StructureInfo& info : accel::registry().structures()) {
    const bool is_left_out = info.conformance == accel::Conformance::kBaseline ||
                             info.name == "exhaustive" || info.name == "embree";
    if (!is_left_out && info.origin.empty()) {
      choices.push_back(accel::registry().choose({info.name, {}}));
    }
  }
  return choices;
}

void add_views(Fingerprint& result, base::Progress& progress) {
  const accel::StructureChoice exhaustive = accel::registry().choose({"exhaustive", {}});
  const std::vector<accel::StructureChoice> choices = compared_structures();
  for (const std::string_view spec : kTraced) {
    progress.start(spec);
    const scenes::Scene scene = scenes::load_scene(spec);
    const rays::ImageOfRays image = rays::image_of(scene.cameras.front(), kResolution, 1);
    const accel::Workload workload = rays::workload_of(image, image.rays());
    const Built reference{&exhaustive, exhaustive.build(scene, workload)};
    std::vector<Built> others;
    for (const accel::StructureChoice& choice : choices) {
      if (!choice.info().support.includes(scene)) continue;
      others.push_back({&choice, choice.build(scene, workload)});
    }
    for (const char* kind : kRays) {
      try {
        const auto input = rays::make_trace_input(scene, image, rays::parse_ray_choice(kind));
        add_view(result, spec, input, reference, others);
      } catch (const rays::NoRaysError&) {
        result.add("view", spec, kind, "none", "none");
      }
    }
    progress.finish("ok");
  }
}

int print_fingerprint(const std::string& isa) {
  accel::restrict_to(isa);
  Fingerprint result;
  base::Progress progress(scenes::scene_catalogue().size() + kTraced.size());
  add_scenes(result, progress);
  add_views(result, progress);
  progress.clear();
  result.finish();
  fmt::print("{}", result.text());
  return result.differs ? base::kMismatch : base::kSuccess;
}

}  // namespace

void add_fingerprint_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "fingerprint", "Print hashes of scenes, rays and hits that are equal on every machine");
  const auto isa = std::make_shared<std::string>("best");
  command
      ->add_option("--isa", *isa,
                   "The instruction set of every structure with SIMD: best, avx512, avx2 or sse4")
      ->check(CLI::IsMember(accel::isa_parameter().choices))
      ->type_name("NAME")
      ->capture_default_str();
  command->footer(
      "Prints lines of tab-separated fields, for comparison with diff:\n"
      "  scene      NAME HASH: a scene of the catalog with its defaults\n"
      "  view       SCENE RAYS HASH HASH: hash of the rays, and of every exact structure's hits\n"
      "  differs    SCENE RAYS STRUCTURE HASH: hits that differ from those of 'exhaustive'\n"
      "  all        HASH: hash of all preceding lines\n"
      "  tolerance  STRUCTURE COUNT COUNT COUNT: for a structure with its own arithmetic, the\n"
      "             closest-hit rays, those that hit a different primitive, and those with other "
      "bits of t\n"
      "Takes 10 to 20 seconds. Embree is left out: its versions differ in the last bits of t.\n"
      "Exits with 1 if there is a line 'differs'.\n"
      "Examples:\n"
      "  beambench fingerprint > fingerprint.txt\n"
      "  beambench fingerprint --isa sse4 | tail -2");
  command->callback([isa, &exit_code] { exit_code = print_fingerprint(*isa); });
}

}  // namespace beambench::cli
