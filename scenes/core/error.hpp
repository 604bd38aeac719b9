#pragma once
// The one kind of error a user can cause.

#include <stdexcept>

namespace beambench {

/// The request was wrong: a bad file, name, parameter or configuration. The message is one sentence
/// that names the place (file, line, primitive, parameter), what was expected and the remedy; the
/// command line prints it and exits with 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace beambench
