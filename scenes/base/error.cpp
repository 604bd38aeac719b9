#include "scenes/base/error.hpp"

#include "scenes/base/printable.hpp"

namespace beambench {

InputError::InputError(const std::string& message) : std::runtime_error(message_line(message)) {}

PluginError::PluginError(const std::string& message) : std::runtime_error(message_line(message)) {}

}  // namespace beambench
