#include "harness/thesis/cluster/mpi_transport.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include <mpi.h>

namespace beambench::cluster {
namespace {

Message receive(MPI_Comm processes, const MPI_Status& coming) {
  int size = 0;
  MPI_Get_count(&coming, MPI_BYTE, &size);
  Message message{coming.MPI_SOURCE, static_cast<Tag>(coming.MPI_TAG),
                  Bytes(static_cast<std::size_t>(size))};
  MPI_Recv(message.bytes.data(), size, MPI_BYTE, coming.MPI_SOURCE, coming.MPI_TAG, processes,
           MPI_STATUS_IGNORE);
  return message;
}

/// The pauses between polls: none at first, so that a quick reply is received immediately, then
/// increasing ones, to leave the processor to other processes.
class Backoff {
 public:
  using Clock = std::chrono::steady_clock;

  void rest() {
    if (Clock::now() < sleeps_from_) {
      std::this_thread::yield();
    } else {
      std::this_thread::sleep_for(moment_);
      moment_ = std::min(2 * moment_, kLongest);
    }
  }

 private:
  /// The time for which it polls without a pause. A message and its reply take about 0.1 ms. With
  /// three processes on two processors, values from 0.5 to 20 ms made no difference; shorter values
  /// made runs up to a third slower.
  static constexpr std::chrono::milliseconds kAwake{2};
  static constexpr std::chrono::microseconds kLongest{200};
  Clock::time_point sleeps_from_ = Clock::now() + kAwake;
  std::chrono::microseconds moment_{10};
};

}  // namespace

struct MpiTransport::Mpi {
  MPI_Comm processes = MPI_COMM_NULL;
  /// Messages being sent, each kept until it has left.
  std::vector<MPI_Request> sending;
  std::vector<Bytes> sent;
  /// A buffer for any message, allocated on first use and not initialized.
  std::unique_ptr<std::byte[]> room;  // NOLINT(modernize-avoid-c-arrays): not initialized

  void forget_what_left();
  Message receive_next();
};

/// Frees the messages that have left, with one call of MPI_Testsome.
void MpiTransport::Mpi::forget_what_left() {
  if (sending.empty()) return;
  int left = 0;
  std::vector<int> which(sending.size());
  MPI_Testsome(static_cast<int>(sending.size()), sending.data(), &left, which.data(),
               MPI_STATUSES_IGNORE);
  for (std::size_t i = sending.size(); i-- > 0;) {
    if (sending[i] != MPI_REQUEST_NULL) continue;
    std::swap(sending[i], sending.back());
    std::swap(sent[i], sent.back());
    sending.pop_back();
    sent.pop_back();
  }
}

/// Receives without a probe, because SimGrid's MPI_Probe polls, which takes simulated time.
Message MpiTransport::Mpi::receive_next() {
  constexpr int kLargest = 1 << 26;
  // NOLINTNEXTLINE(modernize-avoid-c-arrays)
  if (!room) room = std::make_unique_for_overwrite<std::byte[]>(kLargest);
  MPI_Status came;
  MPI_Recv(room.get(), kLargest, MPI_BYTE, MPI_ANY_SOURCE, MPI_ANY_TAG, processes, &came);
  int size = 0;
  MPI_Get_count(&came, MPI_BYTE, &size);
  return {came.MPI_SOURCE, static_cast<Tag>(came.MPI_TAG), Bytes(room.get(), room.get() + size)};
}

MpiTransport::MpiTransport(Waiting waiting) : mpi_(std::make_unique<Mpi>()), waiting_(waiting) {
  MPI_Comm_dup(MPI_COMM_WORLD, &mpi_->processes);
  MPI_Comm_rank(mpi_->processes, &self_);
  MPI_Comm_size(mpi_->processes, &processes_);
}

/// Leaves the communicator to MPI_Finalize: freeing it here would require all processes to take
/// part.
MpiTransport::~MpiTransport() = default;

double MpiTransport::seconds() const { return MPI_Wtime(); }

/// Uses MPI_Isend, like the thesis, where the producer first waits until its last message has left.
/// Here each message has a separate buffer, so a slow consumer does not delay the others.
void MpiTransport::send(ProcessId to, Tag tag, Bytes bytes) {
  mpi_->forget_what_left();
  const Bytes& kept = mpi_->sent.emplace_back(std::move(bytes));
  MPI_Isend(kept.data(), static_cast<int>(kept.size()), MPI_BYTE, to, static_cast<int>(tag),
            mpi_->processes, &mpi_->sending.emplace_back());
}

void MpiTransport::flush() {
  MPI_Waitall(static_cast<int>(mpi_->sending.size()), mpi_->sending.data(), MPI_STATUSES_IGNORE);
  mpi_->sending.clear();
  mpi_->sent.clear();
}

std::optional<Message> MpiTransport::poll() {
  int there = 0;
  MPI_Status coming;
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, mpi_->processes, &there, &coming);
  if (there == 0) return std::nullopt;
  return receive(mpi_->processes, coming);
}

std::optional<Message> MpiTransport::wait(double seconds) {
  if (waiting_ == Waiting::kBlocking) return mpi_->receive_next();
  const double deadline = this->seconds() + seconds;
  Backoff startup_timeout;
  while (true) {
    if (auto message = poll()) return message;
    if (this->seconds() >= deadline) return std::nullopt;
    startup_timeout.rest();
  }
}

void MpiTransport::broadcast(Bytes& bytes) {
  auto size = static_cast<std::uint64_t>(bytes.size());
  MPI_Bcast(&size, 1, MPI_UINT64_T, kProducer, mpi_->processes);
  bytes.resize(size);
  MPI_Bcast(bytes.data(), static_cast<int>(size), MPI_BYTE, kProducer, mpi_->processes);
}

}  // namespace beambench::cluster
