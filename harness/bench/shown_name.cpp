#include "harness/bench/shown_name.hpp"

#include <algorithm>

#include "accel/core/registry.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::bench {
namespace {

/// The entry of that name among structures or scenes; nullptr for a stranger, such as a file.
template <class Infos>
const auto* find_info(const Infos& infos, const std::string& name) {
  const auto found =
      std::ranges::find_if(infos, [&](const auto& info) { return info.name == name; });
  return found == infos.end() ? nullptr : &*found;
}

/// `label` is a name with all parameters.
template <class Infos>
std::string shortened(const Infos& infos, const std::string& label) {
  const std::string name = label.substr(0, label.find(':'));
  const auto* info = find_info(infos, name);
  if (info == nullptr || name.size() == label.size()) return label;
  return Parameters(name, info->parameters, parse_spec(label).parameters).short_label();
}

}  // namespace

std::string shown_scene(const std::string& scene) {
  return shortened(scenes::scene_catalogue(), scene);
}

std::string shown_name(const CellId& id) {
  CellId shown = id;
  shown.scene = shown_scene(id.scene);
  shown.parameters.clear();
  const std::string colon = id.parameters.empty() ? "" : ":";
  shown.structure = shortened(accel::registry().structures(), id.structure + colon + id.parameters);
  return shown.name();
}

}  // namespace beambench::bench
