// beambench export: writes a scene as an NFF file, or its triangles as OBJ.

#include <cstdint>
#include <cstdio>
#include <memory>
#include <ostream>
#include <string>

#include <fmt/format.h>

#include "harness/base/messages.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/formats/mesh/obj_writer.hpp"
#include "scenes/formats/nff/nff_writer.hpp"

namespace beambench::cli {
namespace {

struct ExportRequest {
  std::string scene;
  std::string file;
  std::uint32_t frame = 0;
  scenes::ReadOptions options;
};

void export_scene(const ExportRequest& request) {
  const bool obj = request.file.ends_with(".obj");
  if (!obj && !request.file.ends_with(".nff")) {
    throw InputError(
        fmt::format("'{}': scenes are written as NFF or, if they consist of triangles, OBJ; end "
                    "the name with .nff or .obj, which readers use to recognize the format",
                    request.file));
  }
  require_writable(request.file);
  const scenes::Scene scene = open_scene(request.scene, request.frame, request.options);
  write_file(request.file, [&](std::ostream& file) {
    obj ? scenes::mesh::write_obj(scene, file) : scenes::nff::write_nff(scene, file);
  });
  base::print_message(stderr, fmt::format("{}: {}, {} primitives\n", printable(request.file),
                                          scene.name, scene.primitives.size()));
}

}  // namespace

void add_export_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("export", "Write a scene as an NFF or OBJ file");
  const auto request = std::make_shared<ExportRequest>();
  add_scene_option(*command, request->scene);
  command->add_option("-o", request->file, "File to write, .nff or .obj")->required();
  add_frame_option(*command, request->frame);
  command->add_flag("--strict", request->options.strict,
                    "Reject a file with unknown words, ignored fields, degenerate primitives or "
                    "polygons to repair");
  command->footer(
      "An NFF file reads back as the same scene, bit for bit. An OBJ file is for programs that "
      "trace\n"
      "only triangles: it has the triangles of all polygons, numbered from 0 as in the hits of\n"
      "'beambench verify --hits'. Scenes with spheres or cones have no OBJ file. Its numbers are\n"
      "exact if read as float or rounded to float.\n"
      "Examples:\n"
      "  beambench export balls:n=3 -o balls.nff\n"
      "  beambench export tetra:n=5 -o tetra.obj\n"
      "  beambench export falling-spheres --frame 9 -o falling_9.nff\n"
      "  beambench scene balls.nff");
  command->callback([request] { export_scene(*request); });
}

}  // namespace beambench::cli
