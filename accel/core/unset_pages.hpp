#pragma once
// Memory in 2 MiB pages that is not initialized.

#include <new>
#include <utility>
#include <vector>

#include "accel/core/large_pages.hpp"

namespace beambench::accel {

/// Allocates like LargePages, for arrays that are filled right after `resize`; new elements are
/// left uninitialized.
template <class T>
struct UnsetLargePages : LargePages<T> {
  UnsetLargePages() = default;
  template <class U>
  explicit UnsetLargePages(const UnsetLargePages<U>&) {}

  template <class U>
  struct rebind {
    using other = UnsetLargePages<U>;
  };

  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

template <class T>
using UnsetLargePageVector = std::vector<T, UnsetLargePages<T>>;

}  // namespace beambench::accel
