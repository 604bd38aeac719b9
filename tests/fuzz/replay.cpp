// Runs a target over files or over random inputs without libFuzzer: corpora and regressions are
// ordinary tests.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <unistd.h>

#include "scenes/base/decimal.hpp"
#include "scenes/base/random.hpp"
#include "tests/fuzz/target.hpp"

namespace beambench::fuzz {
namespace {

namespace fs = std::filesystem;

/// The time limit for an input, after which SIGALRM ends the process; generous for the sanitizers.
constexpr unsigned kSecondsForOne = 60;

/// Returns a file, or all files of a folder, sorted. A missing path has no files: no fault of the
/// target has been found yet.
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

/// Returns whether the target holds for an input.
bool holds(std::span<const char> input) {
  ::alarm(kSecondsForOne);
  try {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
    return true;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "FAULT: %s\n", error.what());
    return false;
  }
}

struct Result {
  std::size_t inputs = 0;
  std::size_t faults = 0;
};

/// Runs the target over files. Prints each file's name on standard error first: if the process
/// ends, the last line names the cause.
Result replay(std::span<char*> arguments) {
  Result result;
  for (const char* argument : arguments) {
    for (const auto& file : files_of(argument)) {
      std::fprintf(stderr, "%s\n", file.c_str());
      ++result.inputs;
      if (!holds(bytes_of(file))) ++result.faults;
    }
  }
  return result;
}

/// Runs the target over `count` inputs of eight random bytes, the same in each run. In targets that
/// write valid files, these bytes determine the whole file (`Draw`).
Result run_over_random_inputs(std::size_t count) {
  Result result;
  Random random(1);
  for (; result.inputs < count; ++result.inputs) {
    const std::uint64_t bits = random.bits();
    std::array<char, sizeof(bits)> input{};
    std::memcpy(input.data(), &bits, sizeof(bits));
    if (holds(input)) continue;
    std::fprintf(stderr, "with random input %zu\n", result.inputs);
    ++result.faults;
  }
  return result;
}

}  // namespace
}  // namespace beambench::fuzz

/// Takes files and folders, or --random COUNT. Exits with 1 if the target fails for an input or
/// there are no inputs, and with 2 if COUNT is invalid.
int main(int count, char** arguments) {
  const std::span given(arguments + 1, static_cast<std::size_t>(count - 1));
  beambench::fuzz::Result result;
  if (given.size() == 2 && std::string_view(given[0]) == "--random") {
    const auto inputs = beambench::integer_of(given[1]);
    if (!inputs || *inputs < 1) {
      std::fprintf(stderr, "--random '%s': expected a number of inputs from 1 on\n", given[1]);
      return 2;
    }
    result = beambench::fuzz::run_over_random_inputs(static_cast<std::size_t>(*inputs));
  } else {
    result = beambench::fuzz::replay(given);
  }
  const auto [inputs, faults] = result;
  std::printf("%zu inputs, %zu faults\n", inputs, faults);
  return inputs > 0 && faults == 0 ? 0 : 1;
}
