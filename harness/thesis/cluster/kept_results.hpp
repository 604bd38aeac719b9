#pragma once
// Keeps finished results on disk until the picture is written, for `--resume`.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "harness/thesis/cluster/image_worker.hpp"
#include "harness/thesis/cluster/job.hpp"
#include "harness/thesis/cluster/messages.hpp"
#include "harness/thesis/cluster/transport.hpp"
#include "scenes/base/files.hpp"

namespace beambench::cluster {

/// Returns the properties that results for the same picture share, one per line.
std::string picture_key(const Job& job, const Identity& identity);

/// A file to which one process appends results. Added results survive the death of the process;
/// only the last result may be incomplete, and is then ignored.
class KeptFile {
 public:
  /// Creates a new file in the folder, which must exist. Throws InputError.
  KeptFile(const std::filesystem::path& folder, ProcessId process, const std::string& key);
  /// Removes the file if it contains no results.
  ~KeptFile();
  KeptFile(const KeptFile&) = delete;
  KeptFile& operator=(const KeptFile&) = delete;

  /// Adds a result. Throws InputError, for example if the disk is full.
  void add(std::span<const std::byte> task, std::span<const std::byte> result);

 private:
  void write(const Bytes& bytes);

  std::filesystem::path path_;
  int descriptor_ = -1;
  bool empty_ = true;
};

/// The folder PICTURE.kept beside a picture, for one run at a time.
class KeptFolder {
 public:
  /// If `resume` is set, keeps existing results; otherwise removes them. Throws InputError if the
  /// folder cannot be created or is in use by another run.
  KeptFolder(const std::filesystem::path& picture, bool resume);
  /// Removes the folder if it contains no results.
  ~KeptFolder();
  KeptFolder(const KeptFolder&) = delete;
  KeptFolder& operator=(const KeptFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Calls `visit` once for each finished task, with its result. Throws InputError for a file of
  /// another picture, stating the difference.
  void read(const std::string& key,
            const std::function<void(std::span<const std::byte> task,
                                     std::span<const std::byte> result)>& visit) const;
  /// Removes the results once the picture has been written.
  void remove();

 private:
  std::filesystem::path path_;
  std::unique_ptr<FolderLock> lock_;
};

/// Tasks in the form in which they were sent.
using TaskSet = std::set<Bytes>;

/// Provides the tasks of another source, except those that are finished.
class RemainingSource : public TaskSource {
 public:
  RemainingSource(std::unique_ptr<TaskSource> all, TaskSet finished)
      : all_(std::move(all)), finished_(std::move(finished)) {}
  bool next(Bytes& task) override;

 private:
  std::unique_ptr<TaskSource> all_;
  TaskSet finished_;
};

/// Keeps results in the process that made them, and returns a receipt for each result.
class StoringWorker : public TaskWorker {
 public:
  /// All arguments must outlive this object.
  StoringWorker(ImageWorker& worker, KeptFile& file) : worker_(&worker), file_(&file) {}
  void perform(std::span<const std::byte> task, Bytes& result, const Heartbeat& heartbeat) override;
  void write_counts(Bytes& bytes) const override { worker_->write_counts(bytes); }

 private:
  ImageWorker* worker_;
  KeptFile* file_;
  Bytes result_;
};

/// Accepts the receipts of a StoringWorker.
class ReceiptSink : public ResultSink {
 public:
  std::size_t accept(std::span<const std::byte> result) override;
};

}  // namespace beambench::cluster
