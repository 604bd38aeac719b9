#pragma once
// A short list in place: no allocation, and a copy copies what is used.

#include <algorithm>
#include <array>
#include <cstddef>

namespace beambench::accel::beam {

/// At most `Capacity` values. The caller asks `full()` before it pushes.
template <class T, std::size_t Capacity>
class FixedVector {
 public:
  FixedVector() = default;
  ~FixedVector() = default;
  FixedVector(const FixedVector& other) { *this = other; }
  FixedVector(FixedVector&& other) noexcept { *this = other; }
  FixedVector& operator=(FixedVector&& other) noexcept {
    *this = other;
    return *this;
  }
  FixedVector& operator=(const FixedVector& other) {
    size_ = other.size_;
    std::copy_n(other.values_.begin(), size_, values_.begin());
    return *this;
  }

  void push_back(const T& value) { values_[size_++] = value; }
  void clear() { size_ = 0; }
  void resize(std::size_t size) { size_ = size; }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  static constexpr std::size_t capacity() { return Capacity; }
  bool full() const { return size_ == Capacity; }

  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }
  T* begin() { return values_.data(); }
  T* end() { return values_.data() + size_; }
  const T* begin() const { return values_.data(); }
  const T* end() const { return values_.data() + size_; }

 private:
  std::size_t size_ = 0;
  std::array<T, Capacity> values_;
};

}  // namespace beambench::accel::beam
