#pragma once
// The registry: structure names with parameters to built structures.

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "accel/core/workload.hpp"
#include "scenes/core/parameters.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// How a structure's hits are judged.
enum class Conformance {
  kBitExact,   ///< equal to `exhaustive` bit for bit, id and t
  kTolerance,  ///< arithmetic of its own: judged by the differ's classes
  kBaseline    ///< answers nothing by design (`null`); its hits must all be misses
};

/// One structure as the user sees it in `beambench list`.
struct StructureInfo {
  std::string name;
  std::string summary;  ///< one sentence with the source in the literature
  Conformance conformance;
  std::vector<ParameterInfo> parameters;
  /// Builds it over a scene that outlives it, for a workload. Throws InputError when the scene and
  /// the parameters do not go together (a cap is exceeded); the message names the parameter to
  /// change.
  std::function<std::unique_ptr<Accelerator>(const scenes::Scene&, const Parameters&,
                                             const Workload&)>
      build;
  std::string origin{};  ///< the file of the plug-in that it comes from; empty: built in
};

/// A structure picked by the user, its parameters checked: `samet:max_level=6`.
class StructureChoice {
 public:
  StructureChoice(const StructureInfo& info, Parameters parameters)
      : info_(&info), parameters_(std::move(parameters)) {}

  const StructureInfo& info() const { return *info_; }
  const Parameters& parameters() const { return parameters_; }
  /// `samet:max_level=6,max_objects=0,...` with every parameter.
  std::string label() const { return parameters_.label(); }
  /// As short as it can be told: the name and the parameters that are not at their defaults.
  std::string short_label() const { return parameters_.short_label(); }

  /// Builds the structure; also throws std::logic_error when it ignores a parameter it was given.
  std::unique_ptr<Accelerator> build(const scenes::Scene& scene, const Workload& workload) const;
  /// For the usual workload.
  std::unique_ptr<Accelerator> build(const scenes::Scene& scene) const;

 private:
  const StructureInfo* info_;
  Parameters parameters_;
};

/// What a counter of the counting pass counts; printed by `beambench list --counters`.
struct CounterInfo {
  std::string name;
  std::string meaning;  ///< one sentence
};

/// Those of every structure, in the order of `Counter`.
std::span<const CounterInfo> common_counters();

class Registry {
 public:
  void add(StructureInfo info);
  /// What that structure counts beside `common_counters()`.
  void describe_counters(const std::string& structure, std::vector<CounterInfo> counters);
  /// Empty for a structure without counters of its own.
  std::span<const CounterInfo> own_counters(const std::string& structure) const;

  /// In the order of registration.
  std::span<const StructureInfo> structures() const { return structures_; }
  /// Throws InputError for an unknown name (with one that may be meant and all valid ones) or
  /// parameter.
  StructureChoice choose(const Spec& spec) const;
  /// A comma-separated list as typed after --accel; `all` is every structure with its defaults.
  std::vector<StructureChoice> choose_list(std::string_view text) const;

 private:
  std::vector<StructureInfo> structures_;
  std::map<std::string, std::vector<CounterInfo>> own_counters_;
};

/// All structures of this program: those that were built into it, then those of plug-ins.
const Registry& registry();

}  // namespace beambench::accel
