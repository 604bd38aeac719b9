#pragma once
// The query modes of Embree.

#include <span>

#include "accel/embree/image_tracers.hpp"
#include "accel/embree/list_tracers.hpp"

namespace beambench::accel::embree {

/// A query mode of Embree, for the closest hits of an image and for lists of rays.
struct TraceMode {
  const char* name;
  ImageTracers::Trace ImageTracers::*image;
  ListMode ListTracers::*list;
};

/// Returns the modes that the build's Embree version has, simplest first.
std::span<const TraceMode> trace_modes();

}  // namespace beambench::accel::embree
