#pragma once
// Reduces a wrong result to the fewest primitives and one ray.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "accel/core/registry.hpp"
#include "harness/base/progress.hpp"
#include "harness/rays/claimed_hits.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/verify/differ.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// Traces the rays of an input over a scene, like a structure or a program. Throws InputError on
/// failure.
using Tracer = std::function<rays::HitTable(const scenes::Scene& scene, const rays::TraceInput&)>;

/// Returns a tracer that builds the structure anew over each scene.
Tracer tracer_of(const accel::StructureChoice& structure);

/// Returns the report over all rays of an input.
DiffReport verify_tracer(const scenes::Scene& scene, const rays::TraceInput& input,
                         const Tracer& tracer);

/// A function that returns the first wrong result of a subject for an input over a scene, which is
/// a part of the scene where the subject failed. With `like`, only a result with the same fault
/// (`first_fault`) counts. It returns nothing if all results are correct, or if the subject fails
/// differently.
using FindWrong = std::function<std::optional<Mismatch>(
    const scenes::Scene& scene, const rays::TraceInput&, const Mismatch* like)>;

/// Returns the first fault of a report with the same class and reason as `like`; without `like`,
/// the first fault. The report's scene is a part of the scene of `like`. A leak must still be a
/// leak: rays just beside it, on all sides, hit this part.
std::optional<Mismatch> first_fault(const scenes::Scene& scene, const DiffReport& report,
                                    const Mismatch* like);

/// Returns a function that finds faults with the differ.
FindWrong wrong_by_differ(Tracer tracer);

/// A wrong result, over a part of a scene.
struct MinimalCase {
  scenes::Scene scene;
  std::vector<scenes::PrimitiveId> primitives;  ///< ids in the whole scene, in the order of `scene`
  /// One ray, or all rays if that many are needed, as for an image whose rays are traced together.
  rays::TraceInput input;
  Mismatch mismatch;     ///< of a ray of `input`
  std::size_t runs = 0;  ///< number of times the subject was run
  bool repeated = true;  ///< false: not traced again; only the primitives of the results remain
};

/// Removes rays, then primitives, as long as the fault of `wrong` remains (Zeller and Hildebrandt,
/// "Simplifying and isolating failure-inducing input", IEEE TSE 28(2), 2002), with at most 2,000
/// runs of `find_wrong`. Returns nothing if the subject does not have this fault when run again.
/// `progress` gets one cell.
std::optional<MinimalCase> minimize(const scenes::Scene& scene, const rays::TraceInput& input,
                                    const Mismatch& wrong, const FindWrong& find_wrong,
                                    base::Progress& progress);

/// Returns the ray and the primitives of its results, for results that cannot be reproduced.
MinimalCase named_case(const scenes::Scene& scene, const Mismatch& wrong);

/// Creates a folder and writes into it: scene.nff; scene.obj if there are only triangles; ray.rays
/// and ray.csv, with only the wrong ray if the rays are an image; case.json with the ray, the
/// results, the remaining primitives of `whole`, and what `subject` traced. Throws InputError.
void write_case(const std::filesystem::path& folder, const MinimalCase& minimal,
                const std::string& whole, const std::string& subject);

}  // namespace beambench::verify
