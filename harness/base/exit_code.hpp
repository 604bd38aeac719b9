#pragma once
// What every program of beambench ends with.

namespace beambench::base {

enum ExitCode : int {
  kSuccess = 0,
  kMismatch = 1,      ///< a mismatch, an error of a structure or a regression was found
  kInvalidInput = 2,  ///< invalid arguments or input
  kInternalError = 70,
  kNotRun = 127,      ///< as shells report it
  kInterrupted = 130  ///< as shells report it
};

}  // namespace beambench::base
