#pragma once
// Verifies the hits that any program finds for the rays of a file.

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
  rays::Query query;  ///< that the hits answer
  DiffReport report;
  std::vector<std::string> places;  ///< of the report's examples: "ray 17 (hits.csv:18)"
};

/// Reads both files part by part and verifies the hits: any number of them in the same memory.
/// Grazes of rays that may graze do not count in the verdict. `progress` gets one cell. Throws
/// InputError naming file and line or byte for what the files may not hold, for rays of another
/// scene, and where there are not as many hits as rays.
ClaimsReport verify_hit_files(const scenes::Scene& scene, const std::filesystem::path& rays,
                              const std::filesystem::path& hits,
                              ClaimVerifier::OnMismatch on_mismatch, base::Progress& progress);

/// The same with hits that a tracer finds for the rays of a file, which it gets all at once. Throws
/// also as the tracer.
ClaimsReport verify_traced_file(const scenes::Scene& scene, const std::filesystem::path& rays,
                                const Tracer& tracer, ClaimVerifier::OnMismatch on_mismatch,
                                base::Progress& progress);

}  // namespace beambench::verify
