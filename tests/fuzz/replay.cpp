// Runs a target over files or over random inputs, where no libFuzzer is there: corpora and
// regressions are ordinary tests.

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

/// Whether the target holds for an input.
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

/// Names each file on standard error before it is read, so that the last line names it where the
/// process ends.
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

/// Runs over as many inputs of eight random bytes, the same each time. They decide what is drawn
/// (`Draw`): all of a valid file, in targets that write some.
Result run_over_random_inputs(std::size_t count) {
  Result result;
  Random random(1);
  for (; result.inputs < count; ++result.inputs) {
    const std::uint64_t bits = random.bits();
    std::array<char, sizeof(bits)> input{};
    std::memcpy(input.data(), &bits, sizeof(bits));
    if (holds(input)) continue;
    std::fprintf(stderr, "by random input %zu\n", result.inputs);
    ++result.faults;
  }
  return result;
}

}  // namespace
}  // namespace beambench::fuzz

/// Takes files and folders, or --random COUNT. Exits with 1 where the target fails for one input,
/// or there is none, with 2 where COUNT is not a number.
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
