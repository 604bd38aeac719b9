#pragma once
// Calling code of a plug-in.

#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scenes/core/error.hpp"
#include "scenes/core/plugin_error.hpp"

namespace beambench::plugin {

/// Calls `code`, which is a plug-in's. An InputError is passed on, as is a lack of memory; whatever
/// else it throws becomes a PluginError: `who` is the plug-in's file, `what` what it was asked for.
template <class Code>
decltype(auto) foreign_call(std::string_view who, std::string_view what, Code&& code) {
  try {
    return std::forward<Code>(code)();
  } catch (const InputError&) {
    throw;
  } catch (const PluginError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw PluginError(fmt::format("the plug-in {} threw {}: {}", who, what, error.what()));
  } catch (...) {
    throw PluginError(
        fmt::format("the plug-in {} threw {} something that is no std::exception", who, what));
  }
}

}  // namespace beambench::plugin
