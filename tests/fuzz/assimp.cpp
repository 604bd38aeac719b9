// The formats that Assimp reads, each input in its own process, as in the program. This is slow,
// and the importer's coverage is not recorded, so inputs are mutated blindly. The first line of an
// input is the file's ending; the remaining lines are the file.

#include <csignal>
#include <cstdlib>
#include <string>

#include <pthread.h>

#include "scenes/formats/mesh/mesh_file.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"
#include "scenes/formats/mesh/mesh_scene.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/target.hpp"

/// Provided by a sanitizer, if the program was built with one.
extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));

namespace {

using namespace beambench;

/// Removes libFuzzer's handlers from the child process: the parent reports a crash of the importer,
/// and the child's copy of libFuzzer must not treat it as a fault.
void forget_fuzzer() {
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGXCPU, SIGALRM}) {
    std::signal(signal, SIG_DFL);
  }
  if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(nullptr);
}

/// Prepares a process, once. Without a cache folder, each input is imported.
bool prepare() {
  for (const char* place : {"BEAMBENCH_CACHE", "XDG_CACHE_HOME", "HOME"}) ::unsetenv(place);
  return ::pthread_atfork(nullptr, nullptr, forget_fuzzer) == 0;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::ScratchFolder folder;
  static const bool prepared = prepare();
  fuzz::require(prepared, "the handler of forked processes cannot be registered");
  const std::string_view text = fuzz::text_of(data, size);
  const std::size_t line = text.find('\n');
  if (line == std::string_view::npos) return 0;
  const std::string name = "input." + std::string(text.substr(0, line));
  const std::string ending = scenes::mesh::mesh_ending(name);
  if (ending.empty() || name != "input." + ending) return 0;
  if (!scenes::mesh::importer_of(ending).starts_with("assimp")) return 0;  // read by another target
  const auto file = folder.write(name, text.substr(line + 1));
  fuzz::accepted([&] {
    return scenes::mesh::load_mesh({file, name, scenes::mesh::usual_orientation(ending)});
  });
  return 0;
}
