// Runs a target over files, where no libFuzzer is there: corpora and regressions are ordinary
// tests.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include <unistd.h>

#include "tests/fuzz/target.hpp"

namespace beambench::fuzz {
namespace {

namespace fs = std::filesystem;

/// No input may take longer: SIGALRM ends the process then. Generous, for the sanitizers.
constexpr unsigned kSecondsForOne = 60;

/// A file, or all files of a folder, sorted; none of what is not there: no fault was found yet.
std::vector<fs::path> files_of(const fs::path& path) {
  if (!fs::exists(path)) return {};
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::vector<char> bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Whether the target holds for the file; says on standard error which one it is first, so that
/// the last line names it where the process ends.
bool holds(const fs::path& path) {
  const std::vector<char> bytes = bytes_of(path);
  std::fprintf(stderr, "%s\n", path.c_str());
  ::alarm(kSecondsForOne);
  try {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    return true;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "FAULT: %s\n", error.what());
    return false;
  }
}

}  // namespace
}  // namespace beambench::fuzz

/// Takes files and folders. Exits with 1 where the target fails for one, or there is none.
int main(int count, char** arguments) {
  std::size_t files = 0;
  std::size_t faults = 0;
  for (const char* argument : std::span(arguments, static_cast<std::size_t>(count)).subspan(1)) {
    for (const auto& file : beambench::fuzz::files_of(argument)) {
      ++files;
      if (!beambench::fuzz::holds(file)) ++faults;
    }
  }
  std::printf("%zu inputs, %zu faults\n", files, faults);
  return files > 0 && faults == 0 ? 0 : 1;
}
