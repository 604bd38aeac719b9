// beambench explain: writes a page that shows how structures trace a scene, ray by ray.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness/base/progress.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/text.hpp"
#include "harness/explain/explain_page.hpp"
#include "harness/explain/explanation.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::cli {
namespace {

struct ExplainRequest {
  std::string scene;
  std::string structures;
  std::string file;
  std::string resolution;
  ViewRequest view;
  std::uint32_t frame = 0;
};

void explain(const ExplainRequest& request) {
  const std::vector<accel::StructureChoice> choices =
      accel::registry().choose_list(request.structures);
  require_writable(request.file);
  const scenes::Scene scene = open_scene(request.scene, request.frame);
  const scenes::Camera camera = choose_camera(scene, request.view);
  const rays::ImageOfRays image =
      rays::image_of(camera,
                     request.resolution.empty() ? explain::default_resolution(camera)
                                                : rays::parse_resolution(request.resolution),
                     1);
  base::Progress progress(1);
  progress.start(fmt::format("{} over {}", request.structures, scene.name));
  const std::string page = explain::explain_page(
      explain::explain(scene, image, choices, [&](double part) { progress.advance(part); }));
  progress.clear();
  write_file(request.file, page);
  fmt::print("{}: {}; open it in a browser\n", printable(request.file), format_bytes(page.size()));
}

}  // namespace

void add_explain_command(CLI::App& app, int& /*exit_code*/) {
  CLI::App* command = app.add_subcommand(
      "explain", "Write a page that shows in 3D how structures trace a scene, ray by ray");
  const auto request = std::make_shared<ExplainRequest>();
  add_scene_option(*command, request->scene);
  command
      ->add_option("--accel", request->structures,
                   "The structure, or two to show side by side: NAME,NAME2")
      ->required()
      ->type_name("NAME[:PARAM=VALUE,...][,NAME2]");
  command->add_option("-o,--output", request->file, "The page to write, such as page.html")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--resolution", request->resolution,
                   "The image whose rays are followed: WxH, at most 65536 pixels; default: 96 "
                   "pixels along the longer side")
      ->type_name("WxH");
  add_view_options(*command, request->view);
  add_frame_option(*command, request->frame);
  command->footer(
      "The page works in any current browser, without network access. It shows the scene; the "
      "structure's\n"
      "cells or nodes by level; each ray of the image step by step, with the primitives tested "
      "and\n"
      "the one that is hit; the beams of the image by what becomes of them (beam); tiles, blocks "
      "and\n"
      "the pencils of lights (tile-beam); and maps of the work per pixel, in which a click selects "
      "a\n"
      "ray. Scenes of more than 200000 triangles are decimated for display only.\n"
      "Examples:\n"
      "  beambench explain escena2 --accel beam -o beam.html\n"
      "  beambench explain escena2 --accel samet,sah-bvh -o two.html\n"
      "  beambench explain habitacion --accel tile-beam --resolution 128x96 -o tiles.html");
  command->callback([request] { explain(*request); });
}

}  // namespace beambench::cli
