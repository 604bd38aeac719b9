#pragma once
// `beambench verify SCENE --rays FILE --hits FILE`.

#include <string>

#include "harness/cli/inputs.hpp"

namespace beambench::cli {

/// Files of hits and what to write about them.
struct VerifyHitsRequest {
  std::string scene;
  std::string rays;
  std::string hits;
  ViewRequest view;        ///< of the picture
  std::string resolution;  ///< of the picture
  std::string json;        ///< empty: none
  std::string pictures;    ///< folder; empty: none
};

/// Verifies the hits, prints what was found and returns the exit code.
int verify_hits(const VerifyHitsRequest& request);

}  // namespace beambench::cli
