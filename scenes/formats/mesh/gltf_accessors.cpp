#include "scenes/formats/mesh/gltf_accessors.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "scenes/formats/mesh/gltf_file.hpp"

namespace beambench::scenes::mesh {
namespace {

/// The elements of an accessor without a buffer.
constexpr std::array<unsigned char, 64> kZeros{};

std::string name_of(int accessor) { return fmt::format("accessor {}", accessor); }

/// Returns bytes of a buffer.
std::span<const unsigned char> bytes_of_view(const tinygltf::Model& model, int view,
                                             std::string_view user) {
  const tinygltf::BufferView& found = element_of(model.bufferViews, view, "buffer view", user);
  const tinygltf::Buffer& buffer =
      element_of(model.buffers, found.buffer, "buffer", fmt::format("buffer view {}", view));
  const std::size_t size = buffer.data.size();
  if (found.byteOffset > size || found.byteLength > size - found.byteOffset) {
    refuse_gltf(
        fmt::format("buffer view {} ends after its buffer, which has {} bytes", view, size));
  }
  return std::span(buffer.data).subspan(found.byteOffset, found.byteLength);
}

/// Returns the part of a view that holds `count` elements. Throws InputError if it does not.
const unsigned char* elements_in(std::span<const unsigned char> view, std::size_t offset,
                                 std::size_t count, std::size_t size, std::size_t stride,
                                 std::string_view user) {
  const bool fits = offset <= view.size() && view.size() - offset >= size &&
                    (view.size() - offset - size) / stride >= count - 1;
  if (!fits) {
    refuse_gltf(fmt::format("{} has {} elements, more than its buffer view contains", user, count));
  }
  return view.data() + offset;
}

std::size_t component_size(int component) {
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component));
  return size > 0 ? static_cast<std::size_t>(size) : 0;
}

template <typename T>
T number_at(const unsigned char* bytes) {
  T number;
  std::memcpy(&number, bytes, sizeof(T));
  return number;
}

std::uint32_t index_at(const unsigned char* bytes, int component) {
  switch (component) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return number_at<std::uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return number_at<std::uint16_t>(bytes);
    default:
      return number_at<std::uint32_t>(bytes);
  }
}

bool is_index_type(int component) {
  return component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

/// Returns an integer; a normalized one ranges from -1 (signed) or 0 to 1.
template <typename T>
double integer_at(const unsigned char* bytes, std::size_t index, bool normalized) {
  const double number = number_at<T>(bytes + index * sizeof(T));
  return normalized ? std::max(number / std::numeric_limits<T>::max(), -1.0) : number;
}

/// Returns one component of an element.
double component_at(const unsigned char* bytes, std::size_t index,
                    const tinygltf::Accessor& accessor) {
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return integer_at<std::int8_t>(bytes, index, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return integer_at<std::uint8_t>(bytes, index, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return integer_at<std::int16_t>(bytes, index, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return integer_at<std::uint16_t>(bytes, index, accessor.normalized);
    default:
      return number_at<float>(bytes + index * sizeof(float));
  }
}

/// Returns whether `component_at` reads the type.
bool is_number_type(int component) {
  return component == TINYGLTF_COMPONENT_TYPE_FLOAT || component == TINYGLTF_COMPONENT_TYPE_BYTE ||
         component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component == TINYGLTF_COMPONENT_TYPE_SHORT ||
         component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
}

}  // namespace

GltfElements::GltfElements(const tinygltf::Model& model, int accessor, std::string_view of)
    : accessor_(&element_of(model.accessors, accessor, "accessor", of)) {
  const int components =
      tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor_->type));
  const std::size_t size =
      component_size(accessor_->componentType) * static_cast<std::size_t>(std::max(components, 0));
  const std::string user =
      of == kPrimitive ? name_of(accessor) : fmt::format("{} of {}", name_of(accessor), of);
  if (size == 0 || size > kZeros.size()) {
    refuse_gltf(fmt::format("{} has numbers of an unknown type", user));
  }
  stride_ = size;
  count_ = accessor_->count;
  if (count_ == 0) refuse_gltf(fmt::format("{} has no elements", user));
  if (accessor_->bufferView >= 0) {
    const auto view = bytes_of_view(model, accessor_->bufferView, user);
    const std::size_t given =
        model.bufferViews[static_cast<std::size_t>(accessor_->bufferView)].byteStride;
    if (given > 0) stride_ = given;
    if (stride_ < size) {
      refuse_gltf(fmt::format("{} has elements of {} bytes every {} bytes", user, size, stride_));
    }
    first_ = elements_in(view, accessor_->byteOffset, count_, size, stride_, user);
  } else if (!accessor_->sparse.isSparse) {
    refuse_gltf(fmt::format("{} has no buffer view", user));
  }
  sparse_stride_ = size;
  if (accessor_->sparse.isSparse) read_sparse(model, accessor);
}

void GltfElements::read_sparse(const tinygltf::Model& model, int number) {
  const auto& sparse = accessor_->sparse;
  const std::string user = fmt::format("sparse accessor {}", number);
  // Signed or not, depending on tinygltf's version.
  const bool negative =
      std::cmp_less(sparse.indices.byteOffset, 0) || std::cmp_less(sparse.values.byteOffset, 0);
  if (sparse.count < 1 || negative || !is_index_type(sparse.indices.componentType)) {
    refuse_gltf(fmt::format("{} has an invalid count, offset or type", user));
  }
  const auto count = static_cast<std::size_t>(sparse.count);
  const std::size_t size = component_size(sparse.indices.componentType);
  const unsigned char* indices =
      elements_in(bytes_of_view(model, sparse.indices.bufferView, user),
                  static_cast<std::size_t>(sparse.indices.byteOffset), count, size, size, user);
  sparse_first_ = elements_in(bytes_of_view(model, sparse.values.bufferView, user),
                              static_cast<std::size_t>(sparse.values.byteOffset), count,
                              sparse_stride_, sparse_stride_, user);
  sparse_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    sparse_.push_back(index_at(indices + i * size, sparse.indices.componentType));
  }
  const bool rising =
      std::adjacent_find(sparse_.begin(), sparse_.end(), std::greater_equal<>()) == sparse_.end();
  if (!rising || sparse_.back() >= count_) {
    refuse_gltf(fmt::format("{} has indices that do not increase, or are too large", user));
  }
}

const unsigned char* GltfElements::at(std::size_t index) const {
  if (!sparse_.empty()) {
    const auto found = std::lower_bound(sparse_.begin(), sparse_.end(), index);
    if (found != sparse_.end() && *found == index) {
      return sparse_first_ + static_cast<std::size_t>(found - sparse_.begin()) * sparse_stride_;
    }
  }
  return first_ == nullptr ? kZeros.data() : first_ + index * stride_;
}

GltfPositions::GltfPositions(const tinygltf::Model& model, int accessor)
    : elements_(model, accessor) {
  if (!is_number_type(elements_.accessor().componentType) ||
      elements_.accessor().type != TINYGLTF_TYPE_VEC3) {
    refuse_gltf(fmt::format("{} has positions, but they are not three floats, bytes or shorts each",
                            name_of(accessor)));
  }
}

glm::dvec3 GltfPositions::at(std::size_t index) const {
  const unsigned char* bytes = elements_.at(index);
  return {component_at(bytes, 0, elements_.accessor()),
          component_at(bytes, 1, elements_.accessor()),
          component_at(bytes, 2, elements_.accessor())};
}

GltfNumbers::GltfNumbers(const tinygltf::Model& model, int accessor, int type,
                         std::string_view user)
    : elements_(model, accessor, user) {
  if (is_number_type(elements_.accessor().componentType) && elements_.accessor().type == type) {
    return;
  }
  refuse_gltf(fmt::format("{} of {} does not have the required type", name_of(accessor), user));
}

double GltfNumbers::at(std::size_t index, std::size_t number) const {
  return component_at(elements_.at(index), number, elements_.accessor());
}

GltfIndices::GltfIndices(const tinygltf::Model& model, int accessor) : elements_(model, accessor) {
  if (!is_index_type(elements_.accessor().componentType) ||
      elements_.accessor().type != TINYGLTF_TYPE_SCALAR) {
    refuse_gltf(
        fmt::format("{} has indices, but they are not unsigned integers", name_of(accessor)));
  }
}

std::uint32_t GltfIndices::at(std::size_t index) const {
  return index_at(elements_.at(index), elements_.accessor().componentType);
}

}  // namespace beambench::scenes::mesh
