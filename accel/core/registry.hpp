#pragma once
// The registry: structure names with parameters to built structures.

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
  kBitExact,   ///< equal to `exhaustive` bit for bit, id and t
  kTolerance,  ///< arithmetic of its own: classified by the differ
  kBaseline    ///< returns misses by design (`null`), and nothing else
};

/// The purpose of a structure, as far as it is known; structures choose `auto` parameters by it. It
/// changes no hit.
struct Workload {
  scenes::Camera camera;  ///< of the primary rays, or of those that secondary rays start from
  std::size_t rays;       ///< their approximate number
  int threads = 1;        ///< for tracing an image; 0: see `thread_count`
  bool has_lists = true;  ///< false if images are traced, and nothing else
};

/// Returns the workload to assume where none is known: 640x480 rays from the scene's first camera.
inline Workload usual_workload(const scenes::Scene& scene) {
  constexpr std::size_t kUsual = 640UL * 480UL;
  return {scene.cameras.front(), kUsual, 1};
}

/// One structure as the user sees it in `beambench list`.
struct StructureInfo {
  std::string name;
  std::string summary;  ///< one sentence with the source in the literature
  Conformance conformance;
  std::vector<ParameterInfo> parameters;
  /// Builds it over a scene that outlives it, for a workload. Throws InputError when the parameters
  /// do not suit the scene (a cap is exceeded); the message names the parameter to change.
  std::function<std::unique_ptr<Accelerator>(const scenes::Scene&, const Parameters&,
                                             const Workload&)>
      build;
  Support support{};     ///< the rays and primitives that it takes
  std::string origin{};  ///< the file of the plug-in that it comes from; empty: built in
};

/// A structure chosen by the user, with checked parameters: `samet:max_level=6`.
class StructureChoice {
 public:
  StructureChoice(const StructureInfo& info, Parameters parameters)
      : info_(&info), parameters_(std::move(parameters)) {}

  const StructureInfo& info() const { return *info_; }
  const Parameters& parameters() const { return parameters_; }
  /// `samet:max_level=6,max_objects=0,...` with every parameter.
  std::string label() const { return parameters_.label(); }
  /// The name and the parameters that are not at their defaults.
  std::string short_label() const { return parameters_.short_label(); }

  /// Returns whether it is built over a scene's first frame, and updated (`update_parameter`).
  bool updates() const;

  /// Builds the structure; one that `updates()` is a MovedStructure. Throws UnsupportedError over
  /// primitives that it does not support; InputError also when it is expected to take more memory
  /// than is available (`require_build_memory`); std::logic_error when it ignores a parameter it
  /// was given.
  std::unique_ptr<Accelerator> build(const scenes::Scene& scene, const Workload& workload) const;
  /// Builds it for the usual workload.
  std::unique_ptr<Accelerator> build(const scenes::Scene& scene) const;

 private:
  const StructureInfo* info_;
  Parameters parameters_;
};

/// Returns the parameter of a structure that can be updated (`Accelerator::update`), a flag: over a
/// scene that has moved it is then built over the first frame and updated to the present one, in
/// place of being built anew.
ParameterInfo update_parameter();

/// The meaning of a counter; printed by `beambench list --counters`.
struct CounterInfo {
  std::string name;
  std::string meaning;  ///< one sentence
};

/// Returns the counters of every structure, in the order of `Counter`.
std::span<const CounterInfo> common_counters();

class Registry {
 public:
  void add(StructureInfo info);
  /// Registers the counters that a structure has besides `common_counters()`.
  void describe_counters(const std::string& structure, std::vector<CounterInfo> counters);
  /// Returns nothing for a structure without counters of its own.
  std::span<const CounterInfo> own_counters(const std::string& structure) const;

  /// Returns the structures in the order of registration.
  std::span<const StructureInfo> structures() const { return structures_; }
  /// Chooses a structure. Throws InputError for an unknown name (with the nearest valid name and
  /// all valid ones) or parameter.
  StructureChoice choose(const Spec& spec) const;
  /// Chooses a structure; `all` is every structure with its defaults. Throws like `choose`.
  std::vector<StructureChoice> choose_all(const Spec& spec) const;
  /// Reads a comma-separated list as typed after --accel.
  std::vector<StructureChoice> choose_list(std::string_view text) const;

 private:
  /// Refuses a parameter that other structures have, and names them. Leaves others to `Parameters`.
  void require_own_parameter(const StructureInfo& structure, const std::string& name) const;

  std::vector<StructureInfo> structures_;
  std::map<std::string, std::vector<CounterInfo>> own_counters_;
};

/// Returns all structures of this program: the built-in ones, then those of plug-ins.
const Registry& registry();

/// Adds the structures of a plug-in, which were validated (harness/plugin/validation.hpp), to
/// `registry()`. Must be called before the first choice is made: choices point into the registry.
void register_plugin_structures(std::vector<StructureInfo> structures);

}  // namespace beambench::accel
