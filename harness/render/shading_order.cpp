#include "harness/render/shading_order.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "accel/beam/beam_tracer.hpp"
#include "scenes/core/error.hpp"

namespace beambench::render {
namespace {

/// Keeps the samples of one beam after the other.
class PaintedPlaces : public accel::beam::NoBeamWatch {
 public:
  void met(accel::BeamKind, const accel::beam::Beam&) { end_beam(); }
  void painted(std::size_t place) { places_.push_back(place); }
  void finished() { end_beam(); }

  std::vector<std::size_t> take() && { return std::move(places_); }

 private:
  /// A beam finds its samples lattice by lattice, and those that hit before the others.
  void end_beam() {
    std::sort(places_.begin() + static_cast<std::ptrdiff_t>(begin_), places_.end());
    begin_ = places_.size();
  }

  std::vector<std::size_t> places_;
  std::size_t begin_ = 0;  ///< of the beam that was met last
};

}  // namespace

ShadingOrder parse_shading_order(std::string_view name) {
  if (name == "rows") return ShadingOrder::kRows;
  if (name == "scan") return ShadingOrder::kScan;
  if (name == "beams") return ShadingOrder::kBeams;
  throw InputError(fmt::format("there is no order '{}'; choose from: rows, scan, beams", name));
}

std::vector<std::size_t> scan_order(const accel::PrimaryRays& rays) {
  std::vector<std::size_t> places(rays.count());
  std::iota(places.begin(), places.end(), std::size_t{0});
  return places;
}

std::vector<std::size_t> beam_order(const accel::Accelerator& structure,
                                    const accel::PrimaryRays& rays) {
  const auto* tracer = dynamic_cast<const accel::beam::BeamTracer*>(&structure);
  if (tracer == nullptr) {
    throw InputError(
        "only beams have an order of their own: give --accel beam, with parameters if you like, "
        "or --order scan");
  }
  accel::HitBuffer buffer(rays.width(), rays.height(), rays.samples());
  PaintedPlaces painted;
  tracer->trace_watched(rays, buffer, painted);
  std::vector<std::size_t> places = std::move(painted).take();

  std::vector<bool> seen(buffer.size(), false);
  for (const std::size_t place : places) seen[place] = true;
  for (std::size_t place = 0; place < buffer.size(); ++place) {
    if (!seen[place]) places.push_back(place);
  }
  return places;
}

}  // namespace beambench::render
