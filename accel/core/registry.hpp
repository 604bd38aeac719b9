#pragma once
// The registry, which maps structure names and parameters to structures.

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "accel/core/support.hpp"
#include "scenes/base/parameters.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// The way in which a structure's hits are verified.
enum class Conformance {
  kBitExact,   ///< id and t equal those of `exhaustive` bit for bit
  kTolerance,  ///< different arithmetic: hits are classified by the differ
  kBaseline    ///< returns only misses by design (`null`)
};

/// The expected use of a structure, as far as it is known; it determines `auto` parameters, but
/// never hits.
struct Workload {
  scenes::Camera camera;  ///< of the primary rays, or of those that spawn the traced rays
  std::size_t rays;       ///< approximate number of rays
  int threads = 1;        ///< for tracing an image; 0: see `thread_count`
  bool has_lists = true;  ///< false if only images are traced
};

/// Returns the workload to assume when none is known: 640x480 rays from the scene's first camera.
inline Workload usual_workload(const scenes::Scene& scene) {
  constexpr std::size_t kUsual = 640UL * 480UL;
  return {scene.cameras.front(), kUsual, 1};
}

/// A structure as `beambench list` shows it to the user.
struct StructureInfo {
  std::string name;
  std::string summary;  ///< one sentence that cites the source in the literature
  Conformance conformance;
  std::vector<ParameterInfo> parameters;
  /// Builds the structure over a scene, which must outlive it, for a workload. Throws InputError if
  /// the parameters do not suit the scene (for example, a cap is exceeded); the message names the
  /// parameter to change.
  std::function<std::unique_ptr<Accelerator>(const scenes::Scene&, const Parameters&,
                                             const Workload&)>
      build;
  Support support{};     ///< supported rays and primitives
  std::string origin{};  ///< the plug-in's file; empty if built in
};

/// A structure chosen by the user, with checked parameters: `samet:max_level=6`.
class StructureChoice {
 public:
  StructureChoice(const StructureInfo& info, Parameters parameters)
      : info_(&info), parameters_(std::move(parameters)) {}

  const StructureInfo& info() const { return *info_; }
  const Parameters& parameters() const { return parameters_; }
  /// Returns the label with every parameter: `samet:max_level=6,max_objects=0,...`.
  std::string label() const { return parameters_.label(); }
  /// Returns the name with the parameters that are not at their defaults.
  std::string short_label() const { return parameters_.short_label(); }

  /// Returns whether the structure is built over a scene's first frame and then updated
  /// (`update_parameter`).
  bool updates() const;

  /// Builds the structure; a MovedStructure if `updates()`. Throws UnsupportedError if the
  /// structure does not support the scene's primitives; InputError also if it is expected to take
  /// more memory than is available (`require_build_memory`); std::logic_error if its build does not
  /// read a parameter that was set.
  std::unique_ptr<Accelerator> build(const scenes::Scene& scene, const Workload& workload) const;
  /// Builds the structure for the usual workload.
  std::unique_ptr<Accelerator> build(const scenes::Scene& scene) const;

 private:
  const StructureInfo* info_;
  Parameters parameters_;
};

/// Returns the flag `update` of structures that can be updated (`Accelerator::update`). With the
/// flag, a structure over a scene that has moved is built over the first frame and updated to the
/// current frame instead of being rebuilt.
ParameterInfo update_parameter();

/// The meaning of a counter; printed by `beambench list --counters`.
struct CounterInfo {
  std::string name;
  std::string meaning;  ///< one sentence
};

/// Returns the counters that all structures share, in the order of `Counter`.
std::span<const CounterInfo> common_counters();

class Registry {
 public:
  void add(StructureInfo info);
  /// Registers the counters that a structure has besides `common_counters()`.
  void describe_counters(const std::string& structure, std::vector<CounterInfo> counters);
  /// Returns the counters registered for a structure; empty if there are none.
  std::span<const CounterInfo> own_counters(const std::string& structure) const;

  /// Returns the structures in the order of registration.
  std::span<const StructureInfo> structures() const { return structures_; }
  /// Chooses a structure. Throws InputError for an unknown name (with the nearest valid name and
  /// all valid ones) or parameter.
  StructureChoice choose(const Spec& spec) const;
  /// Chooses a structure, or for `all` every structure with its defaults. Throws like `choose`.
  std::vector<StructureChoice> choose_all(const Spec& spec) const;
  /// Reads a comma-separated list as typed after --accel.
  std::vector<StructureChoice> choose_list(std::string_view text) const;

 private:
  /// Throws InputError for a parameter that only other structures have, and names these structures.
  /// Other unknown parameters are left to `Parameters`.
  void require_own_parameter(const StructureInfo& structure, const std::string& name) const;

  std::vector<StructureInfo> structures_;
  std::map<std::string, std::vector<CounterInfo>> own_counters_;
};

/// Returns all structures of this program: the built-in ones, then those of plug-ins.
const Registry& registry();

/// Adds the structures of a plug-in, already validated (harness/plugin/validation.hpp), to
/// `registry()`. Must be called before the first choice, because choices point into the registry.
void register_plugin_structures(std::vector<StructureInfo> structures);

}  // namespace beambench::accel
