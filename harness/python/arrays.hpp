#pragma once
// Uses numpy arrays in C++ without copies.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "accel/core/ray.hpp"

namespace beambench::python {

namespace nb = nanobind;

/// An argument: rows of one type in one block of memory, writable or not. The package converts its
/// arguments to this form.
template <class T, nb::ssize_t... Shape>
using ArrayIn = nb::ndarray<const T, nb::shape<Shape...>, nb::c_contig, nb::device::cpu>;
/// Rows of origin, t_min, direction, t_max.
using RaysIn = ArrayIn<float, -1, 8>;

/// A return value. Const: the array is read-only.
template <class T>
using ArrayOut = nb::ndarray<nb::numpy, T>;

static_assert(sizeof(accel::Ray) == 8 * sizeof(float) && alignof(accel::Ray) == alignof(float));

/// Returns the rays without a copy.
inline std::span<const accel::Ray> rays_of(const RaysIn& rays) {
  return {reinterpret_cast<const accel::Ray*>(rays.data()), rays.shape(0)};
}

/// Throws InputError with the index of the first ray that `require_valid` refuses.
void require_valid_rays(std::span<const accel::Ray> rays);
/// Returns `ray 17: direction is zero; ...` for a problem with the ray.
std::string ray_fault(std::size_t index, std::string fault);

/// An owner for arrays: the object lives until the last of its arrays is destroyed.
template <class T>
nb::capsule keep(T object) {
  return nb::capsule(new T(std::move(object)),
                     [](void* memory) noexcept { delete static_cast<T*>(memory); });
}

/// An array that shares the memory of a vector and owns the vector.
template <class T, class Allocator>
ArrayOut<T> array_of(std::vector<T, Allocator> numbers) {
  auto kept = std::make_unique<std::vector<T, Allocator>>(std::move(numbers));
  T* const data = kept->data();
  const std::size_t size = kept->size();
  return ArrayOut<T>(data, {size}, keep(std::move(kept)));
}

}  // namespace beambench::python
