#pragma once
// Reduces a wrong answer to the fewest primitives and one ray.

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

/// Answers the rays of an input over a scene, as a structure or a program does. Throws InputError
/// where it cannot.
using Tracer = std::function<rays::HitTable(const scenes::Scene& scene, const rays::TraceInput&)>;

/// A structure, built over each scene anew.
Tracer tracer_of(const accel::StructureChoice& structure);

/// The report over all rays of an input.
DiffReport verify_tracer(const scenes::Scene& scene, const rays::TraceInput& input,
                         const Tracer& tracer);

/// The first wrong answer that a subject gives for an input over a scene, which is a part of the
/// one that it failed over. Nothing where all are right, or where the subject fails in another way.
using FindWrong =
    std::function<std::optional<Mismatch>(const scenes::Scene& scene, const rays::TraceInput&)>;

/// By the differ: the first structure error.
FindWrong wrong_by_differ(Tracer tracer);

/// A wrong answer, over a part of a scene.
struct MinimalCase {
  scenes::Scene scene;
  std::vector<scenes::PrimitiveId> primitives;  ///< of the whole scene, in the order of `scene`
  /// One ray; more where it takes them all, as an image whose rays are traced together.
  rays::TraceInput input;
  Mismatch mismatch;     ///< of a ray of `input`
  std::size_t runs = 0;  ///< of the subject
  bool repeated = true;  ///< false: not traced again, what is left is what the answers name
};

/// Takes rays, then primitives away as long as some answer stays wrong (Zeller and Hildebrandt,
/// "Simplifying and isolating failure-inducing input", IEEE TSE 28(2), 2002), by at most 2,000
/// runs of `find_wrong`. Nothing where the subject, asked again, is right. `progress` gets one
/// cell.
std::optional<MinimalCase> minimize(const scenes::Scene& scene, const rays::TraceInput& input,
                                    const Mismatch& wrong, const FindWrong& find_wrong,
                                    base::Progress& progress);

/// The ray and the primitives that its answers name, for answers that nobody can be asked for
/// again.
MinimalCase named_case(const scenes::Scene& scene, const Mismatch& wrong);

/// Writes into a folder, which is made: scene.nff; scene.obj where there are triangles alone;
/// ray.rays and ray.csv, unless the rays are an image; case.json with the ray, the answers, which
/// primitives of `whole` are left, and what was traced by `subject`. Throws InputError.
void write_case(const std::filesystem::path& folder, const MinimalCase& minimal,
                const std::string& whole, const std::string& subject);

}  // namespace beambench::verify
