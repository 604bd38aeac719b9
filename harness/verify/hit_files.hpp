#pragma once
// Verifies hits found by any program for the rays of a file.

#include <filesystem>
#include <string>
#include <vector>

#include "harness/base/progress.hpp"
#include "harness/verify/claim_verifier.hpp"
#include "harness/verify/differ.hpp"
#include "harness/verify/minimize.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

struct ClaimsReport {
  rays::Query query;  ///< the query of the hits
  DiffReport report;
  std::vector<std::string> places;  ///< of the report's examples: "ray 17 (hits.csv:18)"
};

/// Reads both files in parts and verifies any number of hits in constant memory. Applies the
/// `may_graze` and `must_hit` of the ray file; with the argument `must_hit`, all rays must hit.
/// Advances `progress`. Throws InputError with file and line or byte for invalid contents, for rays
/// of another scene, and if the numbers of hits and rays differ.
ClaimsReport verify_hit_files(const scenes::Scene& scene, const std::filesystem::path& rays,
                              const std::filesystem::path& hits,
                              ClaimVerifier::OnMismatch on_mismatch, base::Progress& progress,
                              bool must_hit = false);

/// Verifies hits that a tracer finds for the rays of a file, which it receives all at once. Also
/// throws what the tracer throws.
ClaimsReport verify_traced_file(const scenes::Scene& scene, const std::filesystem::path& rays,
                                const Tracer& tracer, ClaimVerifier::OnMismatch on_mismatch,
                                bool must_hit = false);

}  // namespace beambench::verify
