#include "harness/verify/outside_program.hpp"

#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "accel/core/support.hpp"
#include "harness/base/process_end.hpp"
#include "harness/rays/hit_file.hpp"
#include "harness/rays/ray_file.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/shell_word.hpp"
#include "scenes/formats/mesh/obj_writer.hpp"
#include "scenes/formats/nff/nff_writer.hpp"

namespace beambench::verify {
namespace {

namespace fs = std::filesystem;

/// The exit code by which a program declines a query: that of a skipped test in Automake and Meson.
constexpr int kDeclined = 77;

/// A temporary folder of this process, removed with its contents.
class WorkFolder {
 public:
  WorkFolder() : path_((fs::temp_directory_path() / "beambench-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) {
      throw InputError(
          fmt::format("cannot make a folder in '{}' for the program's files; set TMPDIR",
                      fs::temp_directory_path().string()));
    }
  }
  ~WorkFolder() {
    std::error_code ignored;
    if (!is_kept_) fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  fs::path file(const char* name) const { return fs::path(path_) / name; }
  void keep() { is_kept_ = true; }

 private:
  std::string path_;
  bool is_kept_ = false;
};

bool replace_word(std::string& text, std::string_view word, const fs::path& path) {
  const std::string quoted = shell_quoted(path.string());
  bool found = false;
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += quoted.size()) {
    text.replace(at, word.size(), quoted);
    found = true;
  }
  return found;
}

class OutsideProgram {
 public:
  explicit OutsideProgram(std::string command) : command_(std::move(command)) {}

  rays::HitTable trace(const scenes::Scene& scene, const rays::TraceInput& input) {
    WorkFolder folder;
    const fs::path hits = folder.file("answer.hits");
    std::string command = command_;
    if (const fs::path nff = folder.file("scene.nff"); replace_word(command, "{nff}", nff)) {
      write_file(nff, [&](std::ostream& file) { scenes::nff::write_nff(scene, file); });
    }
    if (const fs::path obj = folder.file("scene.obj"); replace_word(command, "{obj}", obj)) {
      if (!scene.spheres.empty() || !scene.cones.empty()) {
        throw accel::UnsupportedError(
            fmt::format("'{}' has spheres or cones, which {{obj}} cannot express", scene.name));
      }
      write_file(obj, [&](std::ostream& file) { scenes::mesh::write_obj(scene, file); });
    }
    for (const auto& [word, name] :
         {std::pair("{rays}", "trace.rays"), {"{rays_csv}", "trace.csv"}}) {
      if (const fs::path file = folder.file(name); replace_word(command, word, file)) {
        rays::write_ray_file(file, list_of(scene, input), {});
      }
    }
    replace_word(command, "{hits}", hits);
    run(folder, command);
    return read(folder, command, hits, input.size());
  }

 private:
  /// Keeps the files of the first run that fails.
  [[noreturn]] void fail(WorkFolder& folder, const std::string& command,
                         const std::string& problem) {
    const bool is_first = !std::exchange(has_failed_, true);
    if (is_first) folder.keep();
    throw InputError(fmt::format("the command {} {}{}", command, problem,
                                 is_first ? "; its files are kept: try it in a shell" : ""));
  }

  static rays::RaySet list_of(const scenes::Scene& scene, const rays::TraceInput& input) {
    rays::RaySet set;
    set.query = input.query();
    set.scene_hash = scenes::scene_hash(scene);
    for (std::size_t i = 0; i < input.size(); ++i) set.rays.push_back(input.ray(i));
    return set;
  }

  void run(WorkFolder& folder, const std::string& command) {
    const char* where = std::exchange(quiet_, true) ? "( {} ) >/dev/null 2>&1" : "( {} ) >&2";
    const int status = std::system(fmt::format(fmt::runtime(where), command).c_str());
    if (status == 0) return;
    if (WIFEXITED(status) && WEXITSTATUS(status) == kDeclined) {
      throw accel::UnsupportedError(
          fmt::format("the command declines these rays (exit code {})", kDeclined));
    }
    constexpr int kExitOfInterrupted = 128 + SIGINT;  // as shells report it
    if ((WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) ||
        (WIFEXITED(status) && WEXITSTATUS(status) == kExitOfInterrupted)) {
      throw Interrupted(fmt::format("interrupted while {} was running", command));
    }
    constexpr int kLastSignal = 31;
    const int signal = WIFEXITED(status) ? WEXITSTATUS(status) - 128 : 0;
    const bool told_by_shell = signal > 0 && signal <= kLastSignal;
    fail(folder, command, base::describe_end(told_by_shell ? signal : status));
  }

  rays::HitTable read(WorkFolder& folder, const std::string& command, const fs::path& file,
                      std::size_t rays) {
    if (!fs::exists(file)) fail(folder, command, "wrote no hits");
    rays::HitReader reader(file);
    rays::HitTable hits;
    const std::size_t count = reader.read(rays + 1, hits);
    if (count == rays) return hits;
    fail(folder, command,
         fmt::format("wrote {} hits for {} rays",
                     count > rays ? fmt::format("more than {}", rays) : fmt::format("{}", count),
                     rays));
  }

  std::string command_;
  bool quiet_ = false;
  bool has_failed_ = false;
};

}  // namespace

Tracer program_of(const std::string& command) {
  if (command.find("{hits}") == std::string::npos) {
    throw InputError(
        fmt::format("the command '{}' has no {{hits}}, the file that it is to write", command));
  }
  const auto program = std::make_shared<OutsideProgram>(command);
  return [program](const scenes::Scene& scene, const rays::TraceInput& input) {
    return program->trace(scene, input);
  };
}

}  // namespace beambench::verify
