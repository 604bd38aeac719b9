// beambench verify: compares the hits of structures, or of any program, with an exact oracle.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "accel/core/threads.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/text.hpp"
#include "harness/cli/verify_hits.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/plugin/load_plugin.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/render/diagnostics.hpp"
#include "harness/render/verified_picture.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/shell_word.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::cli {
namespace {

constexpr std::size_t kPrintedDisputes = 3;  // for each cell; the JSON has all

struct VerifyRequest {
  std::vector<std::string> scenes;
  std::string hits;
  std::string command;
  std::string kit;
  std::string minimize;
  std::string structures = "all";
  std::string resolution = "320x200";
  ViewRequest view;
  std::uint32_t frame = 0;
  int samples = 1;
  std::string rays = "primary";
  int threads = 1;
  std::string json;
  std::string pictures;
  double timeout = kDefaultTimeout;
  bool verbose = false;
};

std::string bits_text(const verify::VerifiedCell& cell) {
  if (cell.bits_reference.empty()) return "-";
  return cell.different_bits == 0 ? "equal" : fmt::format("{} differ", cell.different_bits);
}

std::string table_text(const std::vector<verify::VerifiedCell>& cells) {
  TextTable table({"scene", "ray kind", "structure", "rays", "hits", "agree", "tie", "graze",
                   "structure error", "oracle error", "bits", "verdict"},
                  3);
  for (const verify::VerifiedCell& cell : cells) {
    std::vector<std::string> row{cell.scene, cell.rays, cell.label};
    if (cell.report) {
      row.push_back(fmt::format("{}", cell.report->rays));
      row.push_back(fmt::format("{}", cell.report->hits));
      for (const std::uint64_t count : cell.report->counts) row.push_back(fmt::format("{}", count));
    } else {
      row.resize(row.size() + 2 + verify::kDiffClassNames.size(), "-");
    }
    row.push_back(bits_text(cell));
    row.emplace_back(verify::to_string(cell.verdict));
    table.add(std::move(row));
  }
  return table.text();
}

void print_disputes(const verify::VerifiedCell& cell) {
  if (!cell.message.empty() && cell.has_rays()) {
    fmt::print("\n{} over {}: {}\n", cell.label, cell.scene, cell.message);
  }
  if (cell.disputes.empty() && cell.picture.empty()) return;
  fmt::print("\n{} over {}, {} rays:\n", cell.label, cell.scene, cell.rays);
  const std::size_t shown = std::min(cell.disputes.size(), kPrintedDisputes);
  for (std::size_t i = 0; i < shown; ++i) fmt::print("{}\n", cell.disputes[i]);
  if (shown < cell.disputes.size()) {
    fmt::print("... and {} more, which --json FILE writes\n", cell.disputes.size() - shown);
  }
  if (!cell.picture.empty()) fmt::print("picture: {}\n", cell.picture);
}

/// Prints why kinds have no rays. Each reason is printed once, because it is the same for all
/// structures.
void print_missing_rays(const std::vector<verify::VerifiedCell>& cells) {
  const std::string* last = nullptr;
  for (const verify::VerifiedCell& cell : cells) {
    if (cell.has_rays() || (last != nullptr && *last == cell.message)) continue;
    fmt::print("\n{} over {}: {}\n", cell.rays, cell.scene, cell.message);
    last = &cell.message;
  }
}

void write_json(const VerifyRequest& request, const std::vector<verify::VerifiedCell>& cells,
                bool passed) {
  nlohmann::ordered_json out{{"beambench", measure::build_info().version},
                             {"resolution", request.resolution},
                             {"samples", request.samples},
                             {"ray_kinds", request.rays},
                             {"threads", accel::thread_count(request.threads)},
                             {"passed", passed},
                             {"cells", nlohmann::ordered_json::array()}};
  for (const verify::VerifiedCell& cell : cells) out["cells"].push_back(to_json(cell));
  write_file(request.json, json_text(out) + '\n');
}

/// Returns the request for verifying the hits of a program. Throws InputError for incompatible
/// options.
VerifyHitsRequest hits_request(const VerifyRequest& request, bool structure_given) {
  VerifyHitsRequest out{.scene = {},
                        .kit = request.kit,
                        .rays = {},
                        .hits = request.hits,
                        .command = request.command,
                        .view = request.view,
                        .resolution = request.resolution,
                        .json = request.json,
                        .pictures = request.pictures,
                        .minimize = request.minimize,
                        .timeout = request.timeout};
  if (!request.kit.empty()) {
    if (!request.scenes.empty() || !request.hits.empty()) {
      throw InputError("--kit has its own scenes, rays and hits; leave out SCENE and --hits");
    }
    if (structure_given) out.structure = choose_one("--accel", request.structures);
    return out;
  }
  const std::string_view option = request.hits.empty() ? "--command" : "--hits";
  if (request.scenes.size() != 1) {
    throw InputError(
        fmt::format("with {}, name one scene: the one over which the rays are traced", option));
  }
  if (!rays::is_ray_file(request.rays)) {
    throw InputError(fmt::format(
        "with {}, --rays is a ray file, not '{}'; 'beambench rays {} -o FILE.rays' writes one",
        option, request.rays, shell_quoted(request.scenes.front())));
  }
  out.scene = request.scenes.front();
  out.rays = request.rays;
  return out;
}

/// Opens all scenes before doing any work, so that an invalid name fails early.
std::vector<scenes::Scene> open_scenes(const VerifyRequest& request) {
  std::vector<scenes::Scene> scenes;
  for (const std::string& spec : request.scenes) scenes.push_back(open_scene(spec, request.frame));
  if (!scenes.empty()) return scenes;
  if (request.frame > 0) throw InputError("--frame applies to animated scenes; name them");
  for (const scenes::SceneInfo& info : scenes::scene_catalogue())
    scenes.push_back(open_scene(info.name));
  return scenes;
}

/// Reduces the first error of each cell, and adds the result to the cell's disputes.
void minimize_errors(const VerifyRequest& request, const verify::VerifiedView& view,
                     const Contenders& contenders, std::vector<verify::VerifiedCell>& cells) {
  for (verify::VerifiedCell& cell : cells) {
    if (!cell.report || cell.report->faults() == 0) continue;
    const auto choice =
        std::ranges::find(contenders.choices, cell.label, &accel::StructureChoice::short_label);
    cell.disputes.push_back(
        minimized_text(request.minimize, fmt::format("{}-{}-{}", cell.scene, cell.rays, cell.label),
                       view.scene, view.input, cell.report->examples.front(),
                       verify::wrong_by_differ(verify::tracer_of(*choice)), cell.label,
                       "--accel " + shell_quoted(cell.label), &view.image.camera) +
        '\n');
  }
}

std::vector<verify::VerifiedCell> verify_kind(
    const scenes::Scene& scene, const rays::ImageOfRays& image, const rays::RayChoice& kind,
    const Contenders& contenders, const VerifyRequest& request, base::Progress& progress) {
  if (kind.kind == rays::RayKind::kWhitted) {
    return render::verify_picture(scene, image, kind, contenders.choices, progress);
  }
  try {
    const verify::VerifiedView view{scene,
                                    image,
                                    rays::make_trace_input(scene, image, kind),
                                    request.threads,
                                    plugin::program_call(),
                                    request.frame};
    verify::DrawDifferences draw;
    if (!request.pictures.empty())
      draw = [&](const verify::ReferenceHits& reference, std::span<const verify::DiffClass> classes,
                 const verify::VerifiedCell& cell) {
        const auto file =
            std::filesystem::path(request.pictures) /
            picture_name(fmt::format("{}-{}-{}", cell.scene, image.camera.name, cell.label));
        render::write_difference(file, reference, classes, {cell.label, render::kOracleName});
        return file.string();
      };
    std::vector<verify::VerifiedCell> cells =
        verify::verify_scene(view, contenders.choices, progress, draw);
    if (!request.minimize.empty()) minimize_errors(request, view, contenders, cells);
    return cells;
  } catch (const rays::NoRaysError& error) {  // the other kinds continue
    return verify::cells_without_rays(scene, kind.label, contenders.choices, progress,
                                      error.what());
  }
}

int verify_structures(const VerifyRequest& request) {
  const rays::Resolution resolution = rays::parse_resolution(request.resolution);
  refuse_structures_as_scenes(request.scenes);
  const std::vector<rays::RayChoice> kinds = rays::parse_ray_choices(request.rays);
  rays::require_ray_count(resolution,
                          static_cast<int>(accel::sample_offsets(request.samples).size()));
  if (!request.json.empty()) require_writable(request.json);
  const std::size_t structures = accel::registry().choose_list(request.structures).size();
  const std::vector<scenes::Scene> scenes = open_scenes(request);
  for (const scenes::Scene& scene : scenes) choose_camera(scene, request.view);
  if (!request.pictures.empty()) make_folder(request.pictures, "choose another with --pictures");

  base::Progress progress(scenes.size() * kinds.size() * structures, stderr,
                          !request.verbose && ::isatty(STDERR_FILENO) == 1);
  std::vector<verify::VerifiedCell> cells;
  for (const scenes::Scene& scene : scenes) {
    const rays::ImageOfRays image{choose_camera(scene, request.view), resolution, request.samples};
    const Contenders contenders = choose_contenders(request.structures, scene);
    if (!contenders.note.empty()) progress.say(contenders.note);
    for (const rays::RayChoice& kind : kinds) {
      progress.skip(structures - contenders.choices.size());
      for (verify::VerifiedCell& cell :
           verify_kind(scene, image, kind, contenders, request, progress)) {
        cells.push_back(std::move(cell));
      }
    }
  }
  progress.clear();

  const bool verified = std::ranges::any_of(cells, &verify::VerifiedCell::was_possible);
  const bool passed = verified && std::ranges::all_of(cells, &verify::VerifiedCell::passed);
  fmt::print("{}", table_text(cells));
  print_oracle_note(std::ranges::any_of(cells, [](const verify::VerifiedCell& cell) {
    return cell.report && cell.report->count(verify::DiffClass::kOracleError) > 0;
  }));
  for (const verify::VerifiedCell& cell : cells) print_disputes(cell);
  print_missing_rays(cells);
  if (!request.json.empty()) write_json(request, cells, passed);
  if (!verified) {
    throw InputError(
        fmt::format("nothing was verified: there are no rays of the kinds '{}', or no structure "
                    "that supports them and the primitives; choose other kinds with --rays, "
                    "another camera or resolution, or other structures",
                    request.rays));
  }
  return passed ? base::kSuccess : base::kMismatch;
}

}  // namespace

void add_verify_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("verify", "Verify hits, ray by ray, against an exact oracle");
  const auto request = std::make_shared<VerifyRequest>();
  command->add_option("SCENE", request->scenes,
                      fmt::format("{}; several may be given (default: the whole catalogue, which "
                                  "takes some minutes)",
                                  kSceneHelp));
  CLI::Option* accel = command
                           ->add_option("--accel", request->structures,
                                        "Structures: NAME:parameter=value,... or all")
                           ->capture_default_str();
  command->add_option("--resolution", request->resolution, "WxH")->capture_default_str();
  command
      ->add_option("--rays", request->rays,
                   "Kinds of rays (see 'beambench list'), or .rays and .csv files")
      ->capture_default_str();
  CLI::Option* hits =
      command
          ->add_option("--hits", request->hits,
                       "Verify the hits that a program wrote to this .hits or .csv file for the "
                       "rays of the file given by --rays")
          ->type_name("FILE");
  CLI::Option* samples =
      command->add_option("--samples", request->samples, "Rays per pixel: 1, 4, 5, 9, 16, ...")
          ->capture_default_str();
  add_view_options(*command, request->view);
  CLI::Option* frame = add_frame_option(*command, request->frame);
  CLI::Option* threads =
      command
          ->add_option("--threads", request->threads,
                       "Number of tracing threads; 0: one per core, within the CPU quota")
          ->capture_default_str()
          ->check(whole_number_in(0, 1024));
  CLI::Option* run =
      command
          ->add_option("--command", request->command,
                       "Verify the hits that this command writes to {hits} for {nff} or {obj} and "
                       "{rays} or {rays_csv}")
          ->type_name("COMMAND");
  command
      ->add_option("--kit", request->kit,
                   "Verify the hits beside the rays in a kit from 'beambench selftest --export', "
                   "or, with --command or --accel, those of a program or structure")
      ->type_name("DIR");
  command
      ->add_option("--minimize", request->minimize,
                   "Reduce an error to the fewest primitives and one ray, and write them to this "
                   "folder")
      ->type_name("DIR");
  for (CLI::Option* option : {accel, samples, threads, frame}) hits->excludes(option);
  for (CLI::Option* option : {accel, samples, threads, frame, hits}) run->excludes(option);
  command->add_option("--json", request->json, "Also write the results to this file");
  command
      ->add_option("--pictures", request->pictures,
                   "Write a picture of the differences to this folder if there are errors")
      ->type_name("DIR");
  add_timeout_option(*command, request->timeout);
  add_verbose_option(*command, request->verbose);
  command->footer(
      "Compares each ray's hit with that of Embree with exact intersectors. agree: the same\n"
      "primitive at the same place; tie: another primitive at the same place; graze: the ray\n"
      "passes a boundary within rounding; structure error, oracle error: the structure or the\n"
      "oracle is wrong, by exact arithmetic over all primitives. bits: whether bit-exact\n"
      "structures return the same bits as exhaustive, or as the first of them. Exits with 1 "
      "unless\n"
      "every verdict is ok (baseline for 'null'; no_rays if the scene has no rays of a kind, "
      "which\n"
      "is an error only if no kind has any). Each error is printed with the 'beambench trace'\n"
      "command that replays it.\n"
      "With --hits or --command, the hits are those of any program; the picture marks the places\n"
      "of hits that do not agree. The formats are in harness/verify/README.md, and\n"
      "'beambench hits' writes an example.\n"
      "Examples:\n"
      "  beambench verify tetera\n"
      "  beambench verify escena1 tetra:n=4 --accel all\n"
      "  beambench verify waving-sheet --frame 7\n"
      "  beambench verify balls:n=3 --rays shadow,reflection,diffuse,random\n"
      "  beambench verify finishes --accel all --rays whitted\n"
      "  beambench rays tetera -o tetera.rays\n"
      "  beambench hits tetera --rays tetera.rays --accel embree -o mine.csv    # or your program\n"
      "  beambench verify tetera --rays tetera.rays --hits mine.csv --pictures .\n"
      "  beambench selftest --export kit --scenes 2\n"
      "  beambench verify --kit kit --command 'beambench hits {nff} --rays {rays} -o {hits}'\n"
      "  beambench verify balls --accel samet:max_level=5,embree --resolution 640x480 --json "
      "v.json");
  command->callback([request, accel, &exit_code] {
    if (request->hits.empty() && request->command.empty() && request->kit.empty()) {
      exit_code = verify_structures(*request);
      return;
    }
    const VerifyHitsRequest hits = hits_request(*request, accel->count() > 0);
    exit_code = hits.kit.empty() ? verify_hits(hits) : verify_kit(hits);
  });
}

}  // namespace beambench::cli
