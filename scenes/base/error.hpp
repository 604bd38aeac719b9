#pragma once
// The errors that users and plug-ins cause.

#include <stdexcept>
#include <string>

namespace beambench {

/// Invalid arguments or input: a file, name, parameter or configuration. The message is one
/// sentence that names the place (file, line, primitive, parameter), what was expected and the
/// remedy; the command line prints it and exits with 2.
class InputError : public std::runtime_error {
 public:
  /// Stores the message as one printable line, whatever its length and content (`message_line`),
  /// because it goes to terminals, records and pages.
  explicit InputError(const std::string& message);
};

/// An error of a plug-in that broke its contract: it threw, or returned nothing or an invalid
/// value. The message is one sentence that names the plug-in and its part; the command line prints
/// it and exits with 1.
class PluginError : public std::runtime_error {
 public:
  /// Stores the message like `InputError`.
  explicit PluginError(const std::string& message);
};

}  // namespace beambench
