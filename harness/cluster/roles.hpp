#pragma once
// What producer and consumers do between messages: the parts of a run that compute.

#include <functional>
#include <span>

#include "harness/cluster/bytes.hpp"

namespace beambench::cluster {

/// The producer's own work: it makes tasks.
class TaskSource {
 public:
  TaskSource() = default;
  TaskSource(const TaskSource&) = delete;
  TaskSource& operator=(const TaskSource&) = delete;
  virtual ~TaskSource() = default;

  /// Appends the next task to a message; false when there are no more.
  virtual bool next(Bytes& task) = 0;
};

/// To be called from time to time within a long task.
using Pulse = std::function<void()>;

/// A consumer's work.
class TaskWorker {
 public:
  TaskWorker() = default;
  TaskWorker(const TaskWorker&) = delete;
  TaskWorker& operator=(const TaskWorker&) = delete;
  virtual ~TaskWorker() = default;

  /// Does a task and appends what came of it to a message. The same task gives the same bytes,
  /// whoever does it. Throws ProtocolError for bytes that are no task.
  virtual void perform(std::span<const std::byte> task, Bytes& result, const Pulse& pulse) = 0;
  /// Appends what it counted; for the report.
  virtual void tell(Bytes&) const {}
};

/// Where results are put together.
class ResultSink {
 public:
  ResultSink() = default;
  ResultSink(const ResultSink&) = delete;
  ResultSink& operator=(const ResultSink&) = delete;
  virtual ~ResultSink() = default;

  /// Results come in any order, each once. Returns how many samples are in it. Throws ProtocolError
  /// for bytes that are no result.
  virtual std::size_t accept(std::span<const std::byte> result) = 0;
};

}  // namespace beambench::cluster
