#pragma once
// The buffer of a stream into something that is already open.

#include <array>
#include <streambuf>

namespace beambench {

/// Sends what a std::ostream is given to a descriptor, which stays open. The stream must be flushed
/// at the end, and is bad once a write has failed.
class DescriptorBuffer : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor);

  /// errno of the write that failed; 0 when none has.
  int error() const { return error_; }

 private:
  int_type overflow(int_type character) override;
  int sync() override;
  bool write_out();

  int descriptor_;
  int error_ = 0;
  std::array<char, 1U << 16U> buffer_{};
};

}  // namespace beambench
