#pragma once
// The reported properties of the machine of a run, and the build of this program.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace beambench::measure {

struct BuildInfo {
  std::string_view version;
  std::string_view commit;  ///< 40 hexadecimal digits, or "unknown" outside of a git checkout
  bool dirty;               ///< whether tracked files were changed since that commit
  std::string_view build_type;
  std::string_view compiler;
  std::string_view flags;
  /// The libraries found when the build was configured.
  std::array<std::pair<std::string_view, std::string_view>, 9> libraries;
};

const BuildInfo& build_info();

struct Machine {
  std::string id;  ///< see machine_id
  std::string cpu;
  unsigned cores;  ///< available to this process
  /// The number of processors whose time this process may use (`beambench::cpu_quota`); nothing: no
  /// limit.
  std::optional<double> cpu_quota;
  std::uint64_t memory_bytes;
  std::string kernel;
  std::string instructions;  ///< the widest vector instructions available: "AVX2"
  bool virtual_machine;      ///< whether the processor reports a hypervisor
  std::uint64_t page_bytes;
  std::string huge_pages;         ///< transparent huge pages: "always", "madvise", "never" or empty
  std::string governor;           ///< frequency governor of the first core; empty: unknown
  std::string turbo;              ///< "on", "off", or empty: unknown
  std::uint64_t executable_hash;  ///< of this program's file
};

/// Inspects this machine; the quota is read below `root`, as in `cpu_quota`.
Machine inspect_machine(const std::filesystem::path& root = "/");

/// Returns sixteen hexadecimal digits that identify a machine without naming it: a fingerprint of
/// the processor (maker, family, model and stepping, since different virtual machines report the
/// same name) and of the installation (machine-id(5), or else the host's name). After a change of
/// processor or system, a machine counts as another machine, since its times change.
std::string machine_id(std::string_view processor, std::string_view installation);

/// Returns the lines that identify the first processor in a text with the layout of Linux's
/// /proc/cpuinfo; empty if there are none.
std::string processor_identity(std::string_view cpuinfo);

/// Returns the conditions that disturb timings and cannot be controlled from here, one sentence
/// each.
std::vector<std::string> disturbances(const Machine& machine);

/// Returns the current time in UTC, `2024-05-31T14:07:09Z`.
std::string utc_now();

}  // namespace beambench::measure
