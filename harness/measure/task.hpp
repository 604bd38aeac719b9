#pragma once
// The work that the contenders of a group do: tracing rays, or drawing a whole picture.

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
  std::vector<std::string> examples;  ///< descriptions of disputed rays, if hits are wrong
};

/// Rays, and one buffer for their results, which the contenders share in turns.
class Task {
 public:
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;
  virtual ~Task() = default;

  const scenes::Scene& scene() const { return *group_.scene; }
  /// Returns the facts of the rays. Determines them with the oracle on the first call, if they are
  /// not yet known.
  const RaySetFacts& facts() {
    if (!facts_) facts_ = find_facts();
    return *facts_;
  }
  accel::Workload workload() {
    return {group_.camera, static_cast<std::size_t>(ray_count()), group_.threads, has_lists()};
  }

  /// Returns a clause about unexpected rays, if there are any.
  virtual std::optional<std::string> warning() { return std::nullopt; }

  /// Overwrites all results with invalid ones, so that the differ finds results that the structure
  /// did not write.
  virtual void poison() = 0;
  /// Throws UnsupportedError if a structure does not support these rays.
  virtual void require_support(const accel::StructureChoice& choice) const = 0;
  /// Traces with a structure. This call is timed.
  virtual void trace(const accel::Accelerator& structure) = 0;
  /// Traces in the same way, but counts work.
  virtual CountedWork count(const accel::Accelerator& structure) = 0;
  /// Returns the fingerprint of all results, bit for bit.
  virtual std::uint64_t fingerprint() const = 0;
  /// Verifies the results; for this, `structure`, built by `choice`, may be traced again.
  virtual Verification verify_results(const accel::Accelerator& structure,
                                      const accel::StructureChoice& choice) = 0;

  /// Returns the query path of `structure`, and the harness's own share of a trace by this path,
  /// measured when first needed. Overwrites all results.
  HarnessShare harness_share(const accel::Accelerator& structure);

 protected:
  /// The group must outlive the task. `known` is as in `make_task`.
  Task(const CellGroup& group, const std::optional<RaySetFacts>& known)
      : group_(group), facts_(known) {}

  virtual RaySetFacts find_facts() = 0;
  virtual std::uint64_t ray_count() = 0;
  virtual bool has_lists() const = 0;
  virtual QueryPath path_of(const accel::Accelerator& structure) const = 0;
  /// Returns the time of a trace by `path` in which finding hits costs nothing. `path` must not be
  /// that of structures that sample images themselves.
  virtual double measure_harness_ms(QueryPath path) = 0;

  const CellGroup& group_;

 private:
  std::optional<RaySetFacts> facts_;
  std::map<QueryPath, double> harness_ms_;
};

/// Makes the task of a group, with its rays in one of their orders. The harness's own time is
/// measured on `core` (-1: any). `known` contains its facts if an earlier process determined them;
/// then the oracle is needed only to verify results. Throws what `make_trace_input` throws, and
/// InputError if the rays differ from the known ones.
std::unique_ptr<Task> make_task(const CellGroup& group, const rays::RayChoice& rays, int core,
                                const std::optional<RaySetFacts>& known);

}  // namespace beambench::measure
