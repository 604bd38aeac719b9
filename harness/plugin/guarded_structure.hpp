#pragma once
// Guards calls of a plug-in's code, and wraps its structures for use by the program.

#include <exception>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "accel/core/registry.hpp"
#include "harness/plugin/activity.hpp"
#include "scenes/base/error.hpp"

namespace beambench::plugin {

/// Calls `code` of a plug-in. InputError and std::bad_alloc are passed on; anything else that it
/// throws becomes a PluginError. `who` is the plug-in's file, and `what` describes the call: "while
/// it was loaded".
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
        fmt::format("the plug-in {} threw {} something that is not a std::exception", who, what));
  }
}

/// Returns the same structure, guarded: `activity` records its current action. Exceptions become a
/// PluginError that names the structure, and so do a missing structure and invalid hits of single
/// rays. Hits of images and batches are left to the differ, so that timed code has only one
/// additional call, not a check of each hit. `activity` must outlive the structure's use.
accel::StructureInfo guarded(accel::StructureInfo info, Activity& activity);

}  // namespace beambench::plugin
