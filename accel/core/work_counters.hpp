#pragma once
// Counts the work of a traversal by a compile-time policy, so that timed code counts nothing.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "scenes/primitive.hpp"

namespace beambench::accel {

/// The counters with the same meaning in every family of structures.
enum class Counter : std::size_t {
  kTraversalSteps,  ///< cells or nodes entered by a ray, leaves included
  kLeaves,          ///< leaves entered, empty ones included
  kEmptyLeaves,     ///< leaves entered that hold no reference
  kBoxTests,        ///< ray-box tests
  kPrimitiveTests,  ///< ray-primitive tests
  kCount
};

/// Column names, in the order of `Counter`.
inline constexpr std::array<std::string_view, static_cast<std::size_t>(Counter::kCount)>
    kCounterNames{"traversal_steps", "leaves", "empty_leaves", "box_tests", "primitive_tests"};

/// Names of the primitive tests by kind, in the order of `scenes::PrimitiveKind`.
inline constexpr std::array<std::string_view, 3> kTestNames{"sphere_tests", "cone_tests",
                                                            "polygon_tests"};

/// The policy of timed code: no work is counted and no step is recorded. A traversal calls its
/// policy
/// - for each piece of work that it does (`add`; for ray-primitive tests, `add_tests`),
/// - for each place it enters (`enter`): `make()` returns the `TraceStep` and is called only by
///   `StepRecorder`,
/// - for each ray-primitive test in that place, with its t or kMiss (`tested`).
struct NoCounting {
  static constexpr void add(Counter, std::uint64_t = 1) {}
  static constexpr void add(std::string_view, std::uint64_t = 1) {}
  static constexpr void add(const NoCounting&) {}
  static constexpr void add_tests(scenes::PrimitiveKind, std::uint64_t = 1) {}
  template <class Make>
  static constexpr void enter(const Make&) {}
  static constexpr void tested(scenes::PrimitiveId, float) {}
};

/// The policy of the counting pass. A family adds its own counters by name.
class WorkCounters {
 public:
  template <class Make>
  static constexpr void enter(const Make&) {}
  static constexpr void tested(scenes::PrimitiveId, float) {}

  void add(Counter counter, std::uint64_t amount = 1) {
    standard_[static_cast<std::size_t>(counter)] += amount;
  }
  void add(std::string_view name, std::uint64_t amount = 1);
  void add(const WorkCounters& other);
  /// Counts ray-primitive tests of one kind, as parts of `Counter::kPrimitiveTests`. Tests of a
  /// polygon's triangles count as tests of polygons.
  void add_tests(scenes::PrimitiveKind kind, std::uint64_t amount = 1) {
    add(Counter::kPrimitiveTests, amount);
    const auto index = static_cast<std::size_t>(kind);
    if (index < tests_.size()) tests_[index] += amount;  // always; else GCC 14 warns
  }

  std::uint64_t get(Counter counter) const { return standard_[static_cast<std::size_t>(counter)]; }
  /// Returns all counters by name: the standard ones, then the family's own; `sphere_tests`,
  /// `cone_tests` and `polygon_tests` if there were tests and all were counted by kind.
  std::map<std::string, std::uint64_t, std::less<>> by_name() const;

 private:
  std::array<std::uint64_t, static_cast<std::size_t>(Counter::kCount)> standard_{};
  std::array<std::uint64_t, kTestNames.size()> tests_{};
  std::map<std::string, std::uint64_t, std::less<>> own_;
};

/// Calls `query(counting)` with the policy for `counters`: `*counters`, or NoCounting if it is
/// null.
template <class Query>
decltype(auto) with_counting(WorkCounters* counters, const Query& query) {
  if (counters != nullptr) [[unlikely]] {
    return query(*counters);
  }
  NoCounting none;
  return query(none);
}

}  // namespace beambench::accel
