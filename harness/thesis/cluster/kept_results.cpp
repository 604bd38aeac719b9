#include "harness/thesis/cluster/kept_results.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "harness/measure/record/machine.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/base/error.hpp"

namespace beambench::cluster {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".kept";
constexpr std::string_view kFile = "results-";

std::uint64_t check_sum(std::span<const std::byte> bytes) {
  return rays::fingerprint(
      std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

InputError failure(const fs::path& path) {
  return InputError(fmt::format("{}: results cannot be kept: {}", path.string(),
                                std::generic_category().message(errno)));
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().starts_with(kFile)) files.push_back(entry.path());
  }
  return files;
}

/// A task with its result.
struct Record {
  std::span<const std::byte> task;
  std::span<const std::byte> result;
};
std::optional<Record> next_record(ByteReader& reader) {
  try {
    const auto sum = reader.get<std::uint64_t>();
    const auto task_size = reader.get<std::uint64_t>();
    const auto result_size = reader.get<std::uint64_t>();
    const auto task = reader.get_bytes(task_size);
    const auto result = reader.get_bytes(result_size);
    if (check_sum({task.data(), task.size() + result.size()}) != sum) return std::nullopt;
    return Record{task, result};
  } catch (const ProtocolError&) {
    return std::nullopt;
  }
}

/// Returns the first line of `a` that differs from the line at the same place in `b`.
std::string first_difference(std::string_view a, std::string_view b) {
  while (!a.empty()) {
    const std::string_view line = a.substr(0, a.find('\n'));
    if (b.substr(0, b.find('\n')) != line) return std::string(line);
    a.remove_prefix(std::min(a.size(), line.size() + 1));
    b.remove_prefix(std::min(b.size(), line.size() + 1));
  }
  return "more than this run";
}

}  // namespace

std::string picture_key(const Job& job, const Identity& identity) {
  const measure::BuildInfo& build = measure::build_info();
  std::string light = "no";
  if (job.light) {
    light = fmt::format("depth {}, least weight {}, shadows {}", job.whitted.max_depth,
                        job.whitted.min_weight, static_cast<int>(job.whitted.shadows));
  }
  return fmt::format(
      "beambench-cluster {}, commit {}{}\nscene {} with hash {:016x}\nstructure {}\noctree of {} "
      "nodes and {} references\ncamera '{}'\nimage {}x{} with {} samples per pixel\nlight: {}\n"
      "work {}\n",
      build.version, build.commit, build.dirty ? " with changes" : "", job.scene, identity.scene,
      job.structure, identity.nodes, identity.references, job.camera, job.resolution.width,
      job.resolution.height, job.samples, light, job.work);
}

KeptFile::KeptFile(const fs::path& folder, ProcessId process, const std::string& key) {
  for (int number = 0; descriptor_ < 0; ++number) {
    path_ = folder / fmt::format("{}{}-{}", kFile, process, number);
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) throw failure(path_);
  }
  Bytes bytes;
  ByteWriter(bytes).put_text(key);
  try {
    write(bytes);
  } catch (...) {
    ::close(descriptor_);
    std::error_code ignored;
    fs::remove(path_, ignored);
    throw;
  }
}

KeptFile::~KeptFile() {
  ::close(descriptor_);
  std::error_code ignored;
  if (empty_) fs::remove(path_, ignored);
}

void KeptFile::add(std::span<const std::byte> task, std::span<const std::byte> result) {
  Bytes both(task.begin(), task.end());
  both.insert(both.end(), result.begin(), result.end());
  Bytes record;
  record.reserve(both.size() + 3 * sizeof(std::uint64_t));
  ByteWriter writer(record);
  writer.put(check_sum(both));
  writer.put(static_cast<std::uint64_t>(task.size()));
  writer.put(static_cast<std::uint64_t>(result.size()));
  writer.put_bytes(both);
  empty_ = false;
  write(record);
}

void KeptFile::write(const Bytes& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw failure(path_);
    done += static_cast<std::size_t>(written);
  }
}

KeptFolder::KeptFolder(const fs::path& picture, bool resume)
    : path_(fs::absolute(picture).string() + std::string(kEnding)) {
  make_folder(path_);
  lock_ = std::make_unique<FolderLock>(path_);
  if (resume) return;
  for (const fs::path& file : files_in(path_)) fs::remove(file);
}

KeptFolder::~KeptFolder() {
  std::error_code ignored;
  fs::remove(path_, ignored);  // fails, as intended, if it contains files
}

void KeptFolder::read(const std::string& key,
                      const std::function<void(std::span<const std::byte>,
                                               std::span<const std::byte>)>& visit) const {
  TaskSet known;
  for (const fs::path& file : files_in(path_)) {
    const std::string text = read_input(file, kLargestFile);
    ByteReader reader(std::as_bytes(std::span(text)));
    std::string its_key;
    try {
      its_key = reader.get_text();
    } catch (const ProtocolError&) {
      continue;  // its process died before writing anything
    }
    if (its_key != key) {
      throw InputError(fmt::format(
          "{}: these results belong to another picture: they have '{}', this run has '{}'; use the "
          "same program and options, or leave out --resume",
          file.string(), first_difference(its_key, key), first_difference(key, its_key)));
    }
    while (const auto record = next_record(reader)) {
      if (known.emplace(record->task.begin(), record->task.end()).second) {
        visit(record->task, record->result);
      }
    }
  }
}

void KeptFolder::remove() {
  std::error_code ignored;
  for (const fs::path& file : files_in(path_)) fs::remove(file, ignored);
  fs::remove(path_, ignored);
}

bool RemainingSource::next(Bytes& task) {
  const std::size_t begin = task.size();
  while (all_->next(task)) {
    const Bytes made(task.begin() + static_cast<std::ptrdiff_t>(begin), task.end());
    if (!finished_.contains(made)) return true;
    task.resize(begin);
  }
  return false;
}

void StoringWorker::perform(std::span<const std::byte> task, Bytes& result,
                            const Heartbeat& heartbeat) {
  result_.clear();
  const std::uint64_t before = worker_->samples();
  worker_->perform(task, result_, heartbeat);
  file_->add(task, result_);
  ByteWriter(result).put(worker_->samples() - before);
}

std::size_t ReceiptSink::accept(std::span<const std::byte> result) {
  return ByteReader(result).get<std::uint64_t>();
}

}  // namespace beambench::cluster
