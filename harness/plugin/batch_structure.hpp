#pragma once
// A structure whose code takes batches of rays as arrays, in a shared object or in another process.

#include <cstdint>
#include <memory>

#include "accel/core/accelerator.hpp"
#include "harness/plugin/c/beambench/contender.h"

namespace beambench::plugin {

/// Foreign code that traces batches over the scene for which it was made.
class BatchTracer {
 public:
  BatchTracer() = default;
  BatchTracer(const BatchTracer&) = delete;
  BatchTracer& operator=(const BatchTracer&) = delete;
  virtual ~BatchTracer() = default;

  /// Write one result for each ray. May be called from several threads. Throw UnsupportedError for
  /// a query that is declined, and PluginError for a query that fails.
  virtual void closest_hits(const beambench_batch& batch, float* t,
                            std::uint32_t* primitive) const = 0;
  virtual void any_hits(const beambench_batch& batch, std::uint8_t* hits) const = 0;
  virtual accel::Statistics statistics() const = 0;
  /// Returns whether all rays of a query must come in one batch, on one thread.
  virtual bool takes_whole_queries() const = 0;
};

/// Returns the structure that traces with `tracer`: lists as one batch for each thread, images as
/// batches of a few rows. If the tracer takes whole queries, each query is one batch.
std::unique_ptr<accel::Accelerator> structure_of(std::unique_ptr<BatchTracer> tracer);

}  // namespace beambench::plugin
