#pragma once
// The work that the contenders of a group trace: rays, or a whole picture.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "accel/core/registry.hpp"
#include "harness/measure/plan.hpp"
#include "harness/measure/record/cell_record.hpp"
#include "harness/verify/differ.hpp"

namespace beambench::measure {

/// The outcome of a verification.
struct Verification {
  verify::DiffReport report;
  std::vector<std::string> examples;  ///< disputed rays, described, where the verdict is bad
};

/// Rays, and one buffer for their results, which contenders use in turns.
class Task {
 public:
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;
  virtual ~Task() = default;

  const scenes::Scene& scene() const { return *group_.scene; }
  /// Returns the facts of the rays. Finds them with the oracle the first time, where they are not
  /// known.
  const RaySetFacts& facts() {
    if (!facts_) facts_ = find_facts();
    return *facts_;
  }
  accel::Workload workload() {
    return {group_.camera, static_cast<std::size_t>(ray_count()), group_.threads, has_lists()};
  }

  /// Returns a clause about unexpected rays.
  virtual std::optional<std::string> warning() { return std::nullopt; }

  /// Overwrites all results with invalid ones, so that the differ finds each one that is not
  /// written.
  virtual void poison() = 0;
  /// Throws UnsupportedError where a structure does not support these rays.
  virtual void require_support(const accel::StructureChoice& choice) const = 0;
  /// Traces with a structure. This is timed.
  virtual void trace(const accel::Accelerator& structure) = 0;
  /// Traces in the same way, counting work.
  virtual CountedWork count(const accel::Accelerator& structure) = 0;
  /// Returns a fingerprint of all results, bit for bit.
  virtual std::uint64_t fingerprint() const = 0;
  /// Verifies the results; may have `structure`, which `choice` has built, trace again for this.
  virtual Verification verify_results(const accel::Accelerator& structure,
                                      const accel::StructureChoice& choice) = 0;

  /// Returns the query path of `structure`, and the harness's own share of a trace by it, which is
  /// measured when it is first needed. Overwrites all results.
  HarnessShare harness_share(const accel::Accelerator& structure);

 protected:
  /// The group must outlive it. `known` as for `make_task`.
  Task(const CellGroup& group, const std::optional<RaySetFacts>& known)
      : group_(group), facts_(known) {}

  virtual RaySetFacts find_facts() = 0;
  virtual std::uint64_t ray_count() = 0;
  virtual bool has_lists() const = 0;
  virtual QueryPath path_of(const accel::Accelerator& structure) const = 0;
  /// Returns the time of a trace by `path`, which is not the structure's own, where results cost
  /// nothing.
  virtual double measure_harness_ms(QueryPath path) = 0;

  const CellGroup& group_;

 private:
  std::optional<RaySetFacts> facts_;
  std::map<QueryPath, double> harness_ms_;
};

/// Makes the task of a group, with its rays in one of their orders. `core` is the core to measure
/// the harness's own time on (-1: any). `known` are its facts where an earlier process found them
/// out: then the oracle is needed only where results are verified. Throws like `make_trace_input`,
/// and InputError where the rays are not those that are known.
std::unique_ptr<Task> make_task(const CellGroup& group, const rays::RayChoice& rays, int core,
                                const std::optional<RaySetFacts>& known);

}  // namespace beambench::measure
