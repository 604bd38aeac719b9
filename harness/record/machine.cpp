#include "harness/record/machine.hpp"

#include <array>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/sysinfo.h>
#include <sys/utsname.h>

#include "harness/record/fingerprint.hpp"

namespace beambench {
namespace {

namespace fs = std::filesystem;

std::string first_line(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t start = line.find_first_not_of(" \t:", line.find(':'));
    if (start != std::string::npos) return line.substr(start);
  }
  return "unknown";
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

double load_average() {
  std::array<double, 1> load{};
  return ::getloadavg(load.data(), 1) == 1 ? load[0] : 0.0;
}

std::uint64_t executable_fingerprint() {
  std::ifstream file("/proc/self/exe", std::ios::binary);
  return fingerprint(std::string(std::istreambuf_iterator<char>(file), {}));
}

}  // namespace

Machine inspect_machine() {
  struct utsname system {};
  ::uname(&system);
  return {hex_digits(fingerprint(std::string_view(system.nodename))),
          cpu_model(),
          usable_cores(),
          memory_size(),
          fmt::format("{} {} {}", system.sysname, system.release, system.machine),
          first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"),
          turbo_state(),
          load_average(),
          executable_fingerprint()};
}

std::vector<std::string> disturbances(const Machine& machine) {
  std::vector<std::string> found;
  if (machine.governor.empty()) {
    found.emplace_back("The system does not tell its frequency governor.");
  } else if (machine.governor != "performance") {
    found.push_back(
        fmt::format("The frequency governor is '{}', not 'performance'.", machine.governor));
  }
  if (machine.turbo.empty()) {
    found.emplace_back("The system does not tell whether its clock is boosted (turbo).");
  } else if (machine.turbo == "on") {
    found.emplace_back("The clock may be boosted (turbo), so it depends on temperature and load.");
  }
  if (machine.load > 0.5) {
    found.push_back(
        fmt::format("Other work was running: the load average was {:.2f}.", machine.load));
  }
  return found;
}

std::string utc_now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

}  // namespace beambench
