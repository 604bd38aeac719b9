#pragma once
// What goes wrong in a plug-in.

#include <stdexcept>

namespace beambench {

/// A plug-in broke its contract: it threw, or returned nothing or nonsense. The message is one
/// sentence that names the plug-in and what of it; the command line prints it and exits with 1.
class PluginError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace beambench
