#include "harness/measure/block_process.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <iterator>
#include <memory>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "accel/core/registry.hpp"
#include "harness/measure/record/cell_json.hpp"
#include "harness/measure/tuning.hpp"
#include "harness/plugin/activity.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::measure {
namespace {

using plugin::Activity;
using Json = nlohmann::ordered_json;

/// Returns rays in the form in which users specify them.
std::string text_of(const rays::RayChoice& rays) {
  return rays.file.empty() ? rays.label : name_of_path(rays.file.string());
}

rays::RayChoice rays_of(const Json& text) {
  return rays::parse_ray_choice(path_of_name(text.get<std::string>()));
}

/// Converts a cell's part of a block. The results of earlier blocks are events, as in a log.
Json to_json(const BlockCell& each) {
  Json json{{"index", each.cell.index},
            {"structure", each.cell.structure.label()},
            {"rays", text_of(each.cell.rays)},
            {"parameter_sets", each.cell.parameter_sets},
            {"repetitions", each.repetitions}};
  if (!each.earlier.diff) return json;
  json["done"] = each.earlier.repetitions.size();
  json["earlier"] = Json::array();
  const CellEvents events([&](const Json& event) { json["earlier"].push_back(event); });
  events.begin_cell(each.earlier);
  events.add_verification(each.earlier);
  return json;
}

Json to_json(const Block& block) {
  Json cells = Json::array();
  for (const BlockCell& each : block.cells) cells.push_back(to_json(each));
  const CellGroup& view = block.view;
  return {{"scene", name_of_path(view.spec)},
          {"scene_hash", view.scene_hash},
          {"camera", view.camera.name},
          {"resolution", rays::to_string(view.resolution)},
          {"samples", view.samples},
          {"rays", text_of(view.rays)},
          {"threads", view.threads},
          {"number", block.number},
          {"first_round", block.first_round},
          {"second_traces", block.second_traces},
          {"tries", block.tries},
          {"core", block.core},
          {"tunes", block.tunes},
          {"cells", cells}};
}

BlockCell read_cell(const Json& json, const CellGroup& view) {
  const accel::StructureChoice structure =
      accel::registry().choose_list(json.at("structure").get<std::string>()).front();
  const rays::RayChoice rays = rays_of(json.at("rays"));
  BlockCell each{{json.at("index").get<std::size_t>(), id_of(view, structure, rays), structure,
                  rays, json.at("parameter_sets").get<int>()},
                 CellRecord{},
                 json.at("repetitions").get<int>()};
  for (const Json& event : json.value("earlier", Json::array())) apply(event, each.earlier);
  each.earlier.repetitions.resize(json.value("done", std::size_t{0}));
  return each;
}

Block read_block(const Json& json) {
  CellGroup view{};
  view.spec = path_of_name(json.at("scene").get<std::string>());
  view.scene = std::make_shared<const scenes::Scene>(scenes::load_scene(view.spec));
  view.scene_hash = scenes::scene_hash(*view.scene);
  if (view.scene_hash != json.at("scene_hash").get<std::uint64_t>()) {
    throw InputError(
        fmt::format("the scene {} has changed during the run; begin a new one", view.scene->name));
  }
  view.camera = scenes::find_camera(*view.scene, json.at("camera").get<std::string>());
  view.resolution = rays::parse_resolution(json.at("resolution").get<std::string>());
  view.samples = json.at("samples").get<int>();
  view.rays = rays_of(json.at("rays"));
  view.threads = json.at("threads").get<int>();
  Block block{std::move(view),
              {},
              json.at("number").get<int>(),
              json.at("first_round").get<int>(),
              json.at("second_traces").get<int>(),
              json.at("tries").get<int>(),
              json.at("core").get<int>(),
              json.at("tunes").get<bool>()};
  for (const Json& cell : json.at("cells")) block.cells.push_back(read_cell(cell, block.view));
  return block;
}

/// A pipe that closes its ends when destroyed. Other programs do not inherit the ends.
class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) {
      throw InputError(fmt::format("cannot start a process for a block: {}", std::strerror(errno)));
    }
  }
  ~Pipe() {
    close_read();
    close_write();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int read_end() const { return ends_[0]; }
  int write_end() const { return ends_[1]; }
  void close_read() { close_end(0); }
  void close_write() { close_end(1); }

 private:
  void close_end(std::size_t end) {
    if (ends_[end] >= 0) ::close(std::exchange(ends_[end], -1));
  }
  std::array<int, 2> ends_{-1, -1};
};

/// Turns a forked process into the program. Calls only functions that are safe between fork and
/// exec: other threads may have been holding locks.
[[noreturn]] void become(char* const* arguments, char* const* environment, pid_t parent, int input,
                         int output) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // the parent has already ended
  ::dup2(input, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::execve(arguments[0], arguments, environment);
  ::_exit(127);
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// The process that measures a block.
class BlockProcess {
 public:
  explicit BlockProcess(std::vector<std::string> program) {
    program.emplace_back(kBlockCommand);
    std::vector<std::string> environment{activity_.variable()};
    for (char** each = environ; *each != nullptr; ++each) environment.emplace_back(*each);
    const std::vector<char*> arguments = pointers_to(program), variables = pointers_to(environment);
    const pid_t parent = ::getpid();
    id_ = ::fork();
    if (id_ == 0) {
      become(arguments.data(), variables.data(), parent, input_.read_end(), output_.write_end());
    }
    if (id_ < 0) {
      throw InputError(fmt::format("cannot start a process for a block: {}", std::strerror(errno)));
    }
    input_.close_read();
    output_.close_write();
  }
  ~BlockProcess() {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }
  BlockProcess(const BlockProcess&) = delete;
  BlockProcess& operator=(const BlockProcess&) = delete;

  void send(std::string_view text) {
    while (!text.empty()) {
      const ssize_t count = ::write(input_.write_end(), text.data(), text.size());
      if (count < 0 && errno != EINTR) break;  // the process has ended; its status says how
      if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
    }
    input_.close_write();
  }

  /// Returns the next whole line; nothing once the process has ended.
  std::optional<std::string> line() {
    for (;;) {
      const std::size_t end = pending_.find('\n');
      if (end != std::string::npos) {
        std::string line = pending_.substr(0, end);
        pending_.erase(0, end + 1);
        return line;
      }
      std::array<char, 1U << 16U> buffer;
      const ssize_t count = ::read(output_.read_end(), buffer.data(), buffer.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return std::nullopt;
      pending_.append(buffer.data(), static_cast<std::size_t>(count));
    }
  }

  /// Returns the cell being measured.
  std::optional<std::size_t> cell() const {
    const std::string text = activity_.read(Activity::Line::kCell);
    if (text.empty()) return std::nullopt;
    return std::strtoull(text.c_str(), nullptr, 10);
  }

  /// Waits for the process to end. Returns how it failed; nothing if it did not.
  std::optional<std::string> end() { return plugin::describe_breakdown(wait(), activity_); }

 private:
  int wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }

  Activity activity_;
  Pipe input_;
  Pipe output_;
  pid_t id_ = -1;
  std::string pending_;
};

}  // namespace

std::optional<BrokenBlock> measure_in_process(const Block& block,
                                              const std::vector<std::string>& program,
                                              const BlockWatch& watch) {
  BlockProcess process(program);
  process.send(json_text(to_json(block), -1));
  while (const std::optional<std::string> line = process.line()) {
    const Json event = parse_json<Json>(*line, "a block's event");
    if (event.at("event") == "refused") throw InputError(event.at("message").get<std::string>());
    watch.before_each_piece(process.cell());
    watch.sink(event);
  }
  const std::optional<std::size_t> cell = process.cell();
  const std::optional<std::string> how = process.end();
  return how ? std::optional(BrokenBlock{cell, *how}) : std::nullopt;
}

void measure_here(const Block& block, const GoogleBenchmark& benchmark, const BlockWatch& watch) {
  if (block.tunes) {
    time_candidates(block, watch);
  } else {
    measure_block(block, benchmark, watch);
  }
}

int serve_block(Activity& activity) {
  // Other output, perhaps from a plug-in, must not mix with the events.
  std::FILE* const out = ::fdopen(::dup(STDOUT_FILENO), "w");
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  const auto write = [out](const Json& event) {
    const std::string line = json_text(event, -1) + '\n';
    if (std::fwrite(line.data(), 1, line.size(), out) != line.size() || std::fflush(out) != 0) {
      std::_Exit(1);  // the reader is gone
    }
  };
  const auto show = [&](std::optional<std::size_t> cell) {
    activity.write(Activity::Line::kCell, cell ? std::to_string(*cell) : "");
  };
  const std::string text{std::istreambuf_iterator<char>(std::cin), {}};
  try {
    const Block block = read_block(parse_json<Json>(text, "a block"));
    measure_here(block, GoogleBenchmark({}), {write, show});
  } catch (const InputError& error) {
    write({{"event", "refused"}, {"message", error.what()}});
  }
  show(std::nullopt);
  return 0;
}

}  // namespace beambench::measure
