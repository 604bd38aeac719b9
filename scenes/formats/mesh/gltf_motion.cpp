#include "scenes/formats/mesh/gltf_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "scenes/formats/mesh/gltf_file.hpp"

namespace beambench::scenes::mesh {
namespace {

/// Bounds on time and memory: node placements over all frames, and stored matrices.
constexpr std::size_t kMaxPlacements = std::size_t{1} << 24U;
constexpr std::size_t kMaxMatrices = std::size_t{1} << 21U;

glm::dmat4 matrix_at(const GltfNumbers& numbers, std::size_t index) {
  glm::dmat4 matrix(1.0);
  for (int i = 0; i < 16; ++i)
    matrix[i / 4][i % 4] = numbers.at(index, static_cast<std::size_t>(i));
  return matrix;
}

}  // namespace

GltfMotion::GltfMotion(tinygltf::Model& model, std::vector<std::string>& warnings)
    : model_(&model) {
  if (!model.animations.empty()) {
    animation_.emplace(model, 0);
    if (model.animations.size() > 1) {
      warnings.push_back(
          fmt::format("{} animations after the first were left out", model.animations.size() - 1));
    }
    if (animation_->others() > 0) {
      warnings.push_back(
          fmt::format("{} channels of its animation were left out: they change neither a "
                      "translation, a rotation "
                      "nor a scale",
                      animation_->others()));
    }
    animation_->pose(model.nodes, 0.0);
  }
  nodes_ = placed_nodes(model);
  moving_.resize(model.nodes.size(), false);
  for (const PlacedNode& node : nodes_) {
    node_of_.emplace(node.number, &node);
    const bool with_parent = node.parent >= 0 && moving_[static_cast<std::size_t>(node.parent)];
    moving_[static_cast<std::size_t>(node.number)] =
        animation_ && (with_parent || animation_->moves(node.number));
  }
  if (animation_) choose_frames(warnings);
}

void GltfMotion::choose_frames(std::vector<std::string>& warnings) {
  const double duration = animation_->duration();
  if (duration == 0.0) return;
  std::size_t matrices = nodes_.size();
  for (const tinygltf::Skin& skin : model_->skins) matrices += skin.joints.size();
  const std::size_t most = std::clamp<std::size_t>(
      std::min(kMaxPlacements / (nodes_.size() + 1), kMaxMatrices / (matrices + 1)), 2, kMaxFrames);
  const double wanted = std::floor(duration * kFrameRate + 1e-6) + 1.0;
  if (wanted > static_cast<double>(most)) {
    frames_ = static_cast<std::uint32_t>(most);
    step_ = duration / static_cast<double>(most - 1);
    warnings.push_back(
        fmt::format("its animation of {:.6g} s has {} frames, evenly spaced, instead of {:.0f}",
                    duration, most, wanted));
    return;
  }
  frames_ = std::max(2U, static_cast<std::uint32_t>(wanted));
  step_ = 1.0 / kFrameRate;
}

double GltfMotion::time_of(std::uint32_t frame) const { return step_ * frame; }

bool GltfMotion::moves(const PlacedNode& node) const {
  return frames_ > 1 && moving_[static_cast<std::size_t>(node.number)];
}

std::uint32_t GltfMotion::add(const Source& source) {
  sources_.push_back(source);
  matrices_.push_back(node_of_.at(source.node)->to_world * source.before);
  return static_cast<std::uint32_t>(sources_.size() - 1);
}

std::uint32_t GltfMotion::matrix_of(const PlacedNode& node) {
  return add({node.number, glm::dmat4(1.0)});
}

std::uint32_t GltfMotion::matrices_of_skin(int skin) {
  if (const auto known = skins_.find(skin); known != skins_.end()) return known->second;
  const tinygltf::Skin& found = element_of(model_->skins, skin, "skin", "a node");
  const std::string user = fmt::format("skin {}", skin);
  if (found.joints.empty()) refuse_gltf(fmt::format("{} has no joints", user));
  std::optional<GltfNumbers> inverse;
  if (found.inverseBindMatrices >= 0) {
    inverse.emplace(*model_, found.inverseBindMatrices, TINYGLTF_TYPE_MAT4, user);
    if (inverse->size() < found.joints.size()) {
      refuse_gltf(fmt::format("{} has {} joints, but {} inverse bind matrices", user,
                              found.joints.size(), inverse->size()));
    }
  }
  const auto first = static_cast<std::uint32_t>(sources_.size());
  for (std::size_t i = 0; i < found.joints.size(); ++i) {
    if (!node_of_.contains(found.joints[i])) {
      refuse_gltf(fmt::format("{} has the joint node {}, which is not in the scene", user,
                              found.joints[i]));
    }
    add({found.joints[i], inverse ? matrix_at(*inverse, i) : glm::dmat4(1.0)});
  }
  skins_.emplace(skin, first);
  return first;
}

std::vector<glm::dmat4> GltfMotion::all_matrices() {
  std::vector<glm::dmat4> all = matrices_;
  all.reserve(frames_ * sources_.size());
  std::vector<glm::dmat4> places(model_->nodes.size());
  for (std::uint32_t frame = 1; frame < frames_; ++frame) {
    animation_->pose(model_->nodes, time_of(frame));
    for (const PlacedNode& node : placed_nodes(*model_)) {
      places[static_cast<std::size_t>(node.number)] = node.to_world;
    }
    for (const Source& source : sources_) {
      all.push_back(places[static_cast<std::size_t>(source.node)] * source.before);
    }
  }
  return all;
}

GltfWeights::GltfWeights(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                         std::size_t vertices) {
  for (int set = 0;; ++set) {
    const auto joints = primitive.attributes.find(fmt::format("JOINTS_{}", set));
    const auto weights = primitive.attributes.find(fmt::format("WEIGHTS_{}", set));
    if (joints == primitive.attributes.end() || weights == primitive.attributes.end()) break;
    const std::string user = "a primitive with a skin";
    sets_.push_back({{model, joints->second, TINYGLTF_TYPE_VEC4, user},
                     {model, weights->second, TINYGLTF_TYPE_VEC4, user}});
    if (sets_.back().joints.size() == vertices && sets_.back().weights.size() == vertices) continue;
    refuse_gltf(fmt::format("{} has {} vertices, but {} joints and {} weights", user, vertices,
                            sets_.back().joints.size(), sets_.back().weights.size()));
  }
  if (sets_.empty()) refuse_gltf("a node has a skin, but its mesh has no JOINTS_0 and WEIGHTS_0");
}

void GltfWeights::append(std::size_t vertex, std::uint32_t first_matrix, std::size_t joints,
                         std::vector<Influence>& influences) const {
  const std::size_t first = influences.size();
  double sum = 0.0;
  for (const Set& set : sets_) {
    for (std::size_t i = 0; i < 4; ++i) {
      const double joint = set.joints.at(vertex, i);
      const double weight = set.weights.at(vertex, i);
      if (!std::isfinite(weight) || weight < 0.0) {
        refuse_gltf(fmt::format("vertex {} of a skin has the weight {}", vertex, weight));
      }
      if (weight == 0.0) continue;
      if (!(joint >= 0.0 && joint < static_cast<double>(joints))) {
        refuse_gltf(fmt::format("vertex {} of a skin has the joint {}, but there are {}", vertex,
                                joint, joints));
      }
      influences.push_back({first_matrix + static_cast<std::uint32_t>(joint), weight});
      sum += weight;
    }
  }
  if (influences.size() == first) influences.push_back({first_matrix, sum = 1.0});
  for (std::size_t i = first; i < influences.size(); ++i) influences[i].weight /= sum;
}

}  // namespace beambench::scenes::mesh
