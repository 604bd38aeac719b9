#pragma once
// The numbers in the buffers of a glTF file.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>
#include <tiny_gltf.h>

namespace beambench::scenes::mesh {

/// The kind of object that refers to an accessor, for messages.
inline constexpr std::string_view kPrimitive = "a primitive";

/// The elements of an accessor, read in place from the buffers, including sparse ones. Must not
/// outlive the model.
class GltfElements {
 public:
  /// Throws InputError with the names of the accessor and its user if the accessor does not exist,
  /// is not entirely within its buffer, or does not define its elements. Allocates memory only for
  /// sparse elements, so their number is limited by the size of the file.
  GltfElements(const tinygltf::Model& model, int accessor, std::string_view user = kPrimitive);

  std::size_t size() const { return count_; }
  const tinygltf::Accessor& accessor() const { return *accessor_; }
  /// Returns the bytes of one element.
  const unsigned char* at(std::size_t index) const;

 private:
  void read_sparse(const tinygltf::Model& model, int number);

  const tinygltf::Accessor* accessor_;
  const unsigned char* first_ = nullptr;  ///< null: all elements are 0, except the sparse ones
  std::size_t stride_ = 0;
  std::size_t count_ = 0;
  std::vector<std::uint32_t> sparse_;  ///< indices, ascending
  const unsigned char* sparse_first_ = nullptr;
  std::size_t sparse_stride_ = 0;
};

/// Vectors, matrices or single numbers, as float or as integers, normalized or not.
class GltfNumbers {
 public:
  /// Throws InputError naming the accessor and its user unless it has elements of the type, such as
  /// TINYGLTF_TYPE_VEC4 (no small matrices, whose columns have gaps).
  GltfNumbers(const tinygltf::Model& model, int accessor, int type, std::string_view user);

  std::size_t size() const { return elements_.size(); }
  /// Returns one of an element's numbers.
  double at(std::size_t index, std::size_t number) const;

 private:
  GltfElements elements_;
};

/// Positions, as float, or (KHR_mesh_quantization) as integers, normalized or not.
class GltfPositions {
 public:
  /// Throws InputError naming the accessor if it does not contain positions.
  GltfPositions(const tinygltf::Model& model, int accessor);

  std::size_t size() const { return elements_.size(); }
  glm::dvec3 at(std::size_t index) const;

 private:
  GltfElements elements_;
};

/// Indices of one, two or four bytes.
class GltfIndices {
 public:
  /// Throws InputError naming the accessor if it does not contain indices.
  GltfIndices(const tinygltf::Model& model, int accessor);

  std::size_t size() const { return elements_.size(); }
  std::uint32_t at(std::size_t index) const;

 private:
  GltfElements elements_;
};

}  // namespace beambench::scenes::mesh
