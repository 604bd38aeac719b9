#include "harness/measure/record/machine.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/sysinfo.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "harness/rays/fingerprint.hpp"
#include "scenes/base/cpu_quota.hpp"

namespace beambench::measure {
namespace {

namespace fs = std::filesystem;

/// Returns the first line of a file of the system. Does not use read_input(): files in /sys are
/// shorter than their stated size, and a missing one is not an error.
std::string first_line(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// Returns the choice in a line like `always [madvise] never`.
std::string chosen(const std::string& line) {
  const std::size_t begin = line.find('[');
  const std::size_t end = line.find(']');
  if (begin == std::string::npos || end == std::string::npos || end < begin) return "";
  return line.substr(begin + 1, end - begin - 1);
}

std::string widest_instructions() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) return "AVX-512";
  if (__builtin_cpu_supports("avx2")) return "AVX2";
  if (__builtin_cpu_supports("avx")) return "AVX";
  return __builtin_cpu_supports("sse4.2") ? "SSE4.2" : "SSE2";
#elif defined(__aarch64__)
  return "NEON";
#else
  return "unknown";
#endif
}

/// Returns the value of a field in /proc/cpuinfo for the first core; empty if it is missing.
std::string cpu_info(std::string_view word) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(word)) continue;
    const std::size_t start = line.find_first_not_of(" \t:", line.find(':'));
    if (start != std::string::npos) return line.substr(start);
  }
  return "";
}

std::string installation() {
  for (const char* file : {"/etc/machine-id", "/var/lib/dbus/machine-id"}) {
    std::string id = first_line(file);
    if (!id.empty() && id != "uninitialized") return id;
  }
  struct utsname system {};
  ::uname(&system);
  return system.nodename;
}

std::string whole_file(const fs::path& path) {
  const std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();  // in blocks, because /proc does not state sizes
  return std::move(content).str();
}

unsigned usable_cores() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (::sched_getaffinity(0, sizeof(cores), &cores) != 0) return 1;
  return static_cast<unsigned>(CPU_COUNT(&cores));
}

std::uint64_t memory_size() {
  struct sysinfo info {};
  return ::sysinfo(&info) == 0 ? std::uint64_t{info.totalram} * info.mem_unit : 0;
}

std::string turbo_state() {
  const fs::path cpu = "/sys/devices/system/cpu";
  const std::string no_turbo = first_line(cpu / "intel_pstate/no_turbo");
  if (!no_turbo.empty()) return no_turbo == "0" ? "on" : "off";
  const std::string boost = first_line(cpu / "cpufreq/boost");
  if (!boost.empty()) return boost == "1" ? "on" : "off";
  return "";
}

}  // namespace

Machine inspect_machine(const fs::path& root) {
  struct utsname system {};
  ::uname(&system);
  const std::string model = cpu_info("model name");
  return {machine_id(processor_identity(whole_file("/proc/cpuinfo")), installation()),
          model.empty() ? "unknown" : model,
          usable_cores(),
          cpu_quota(root),
          memory_size(),
          fmt::format("{} {} {}", system.sysname, system.release, system.machine),
          widest_instructions(),
          (' ' + cpu_info("flags")).find(" hypervisor") != std::string::npos,
          static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)),
          chosen(first_line("/sys/kernel/mm/transparent_hugepage/enabled")),
          first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"),
          turbo_state(),
          rays::fingerprint(whole_file("/proc/self/exe"))};
}

std::string machine_id(std::string_view processor, std::string_view installation) {
  return rays::hex_digits(rays::fingerprint(fmt::format("{}\n{}", processor, installation)));
}

std::string processor_identity(std::string_view cpuinfo) {
  // The fields of x86, then those of ARM, which differ.
  constexpr std::array<std::string_view, 10> kWords{
      "vendor_id",       "cpu family",       "model",       "model name", "stepping",
      "CPU implementer", "CPU architecture", "CPU variant", "CPU part",   "CPU revision"};
  std::string identity;
  std::istringstream lines{std::string(cpuinfo)};
  for (std::string line; std::getline(lines, line) && !line.empty();) {  // ends at an empty line
    const std::string_view word = std::string_view(line).substr(0, line.find_first_of("\t:"));
    if (std::ranges::find(kWords, word) != kWords.end()) identity += line + '\n';
  }
  return identity;
}

std::vector<std::string> disturbances(const Machine& machine) {
  std::vector<std::string> found;
  if (machine.governor.empty()) {
    found.emplace_back("The system does not report its frequency governor.");
  } else if (machine.governor != "performance") {
    found.push_back(
        fmt::format("The frequency governor is '{}', not 'performance'.", machine.governor));
  }
  if (machine.turbo.empty()) {
    found.emplace_back("The system does not report whether its clock is boosted (turbo).");
  } else if (machine.turbo == "on") {
    found.emplace_back("The clock may be boosted (turbo), so it depends on temperature and load.");
  }
  if (machine.virtual_machine) {
    found.emplace_back("This is a virtual machine: others may use the processor at any time.");
  }
  if (machine.huge_pages == "always") {
    found.emplace_back(
        "The system may convert memory to huge pages (transparent huge pages: always), so "
        "identical builds may get different pages.");
  }
  return found;
}

std::string utc_now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

}  // namespace beambench::measure
