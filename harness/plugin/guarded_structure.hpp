#pragma once
// Calling code of a plug-in, and its structures as the program uses them.

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

/// Calls `code`, which is a plug-in's. InputError and std::bad_alloc are passed on; whatever else
/// it throws becomes a PluginError. `who` is the plug-in's file, `what` describes the call: "while
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
        fmt::format("the plug-in {} threw {} something that is no std::exception", who, what));
  }
}

/// The same structure, guarded: `activity` records what it is doing, and what it throws becomes a
/// PluginError that names it, as do a structure that was not built and invalid hits of single rays
/// (the hits of images and batches are left to the differ: timed code pays for one call more, not
/// for a check of each hit). `activity` outlives the program's use of it.
accel::StructureInfo guarded(accel::StructureInfo info, Activity& activity);

}  // namespace beambench::plugin
