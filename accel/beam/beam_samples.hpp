#pragma once
// The samples of a beam: scanline filling that is exact at the edges.

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "accel/beam/beam.hpp"
#include "accel/beam/sample_lattice.hpp"
#include "accel/core/cell_ray.hpp"

namespace beambench::accel::beam {

/// Maps points of the image to samples of a lattice.
class SampleScan {
 public:
  SampleScan(const EyeView& view, const PrimaryRays& rays)
      : view_(&view),
        rays_(&rays),
        row_slack_(2.0 * view.rounding() / glm::length(rays.down()) + 1e-6) {}

  /// Calls `visit(y, first_x, last_x)` for runs of samples that together contain each sample of the
  /// beam exactly once and no others. This is scanline filling (thesis, section 3.6.1) with the
  /// beam's cuts as edges. If a sample's ray, `ray_at(x, y)`, may lie on either side of a cut,
  /// `crosses_before` decides, as in every other beam. The thesis processes some pixels twice;
  /// here, each sample belongs to one beam.
  template <class RayAt, class Visit>
  void for_each_run(const Beam& beam, const SampleLattice& lattice, RayAt ray_at,
                    Visit visit) const {
    const auto belongs = [&](int x, int y) {
      const CellRay cell_ray(view_->grid(), ray_at(x, y));
      return std::all_of(beam.cuts.begin(), beam.cuts.end(), [&](const BeamCut& each) {
        return crosses_before(cell_ray, each.first, each.second);
      });
    };
    double top = beam.outline[0].y;
    double bottom = top;
    for (const glm::dvec2& corner : beam.outline) {
      top = std::min(top, corner.y);
      bottom = std::max(bottom, corner.y);
    }
    const int first_y = std::max(
        lattice.begin.y, first_at_or_after(top * rays_->height() - lattice.offset.y - row_slack_));
    const int last_y =
        last_at_or_before(bottom * rays_->height() - lattice.offset.y + row_slack_, lattice.height);
    const Edges edges(*this, beam, lattice);
    for (int y = first_y; y <= last_y; ++y) {
      const Row row = edges.row(y, lattice.begin.x, lattice.width);
      if (row.first > row.last) continue;
      // Go inward from both ends until no cut is near.
      int first = row.first;
      int last = row.last;
      const int sure_first = std::max(first, row.sure_first);
      const int sure_last = std::min(last, row.sure_last);
      if (sure_first > sure_last) {
        for (int x = first; x <= last; ++x) {
          if (belongs(x, y)) visit(y, x, x);
        }
        continue;
      }
      for (; first < sure_first; ++first) {
        if (belongs(first, y)) visit(y, first, first);
      }
      visit(y, sure_first, sure_last);
      for (int x = sure_last + 1; x <= last; ++x) {
        if (belongs(x, y)) visit(y, x, x);
      }
    }
  }

  Ray ray(const SampleLattice& lattice, int x, int y) const {
    return rays_->ray_at(x + lattice.offset.x, y + lattice.offset.y);
  }

 private:
  /// The samples of a row: those that may belong to the beam, and those that certainly do.
  struct Row {
    int first;
    int last;
    int sure_first;
    int sure_last;
  };

  /// The cuts of a beam as edges on a lattice, in steps of samples.
  class Edges {
   public:
    Edges(const SampleScan& scan, const Beam& beam, const SampleLattice& lattice) {
      for (const BeamCut& each : beam.cuts) {
        const double x = each.line.x / scan.rays_->width();
        const double y = each.line.y / scan.rays_->height();
        const double constant = each.line.constant + x * lattice.offset.x + y * lattice.offset.y;
        edges_.push_back({x, y, constant, 1.0 / x, each.line.band});
      }
      margin_ = scan.view_->rounding();
    }

    /// Returns the samples of a row from `begin` on.
    Row row(int y, int begin, int width) const {
      double first = begin;
      double last = width - 1;
      double sure_first = first;
      double sure_last = last;
      for (const Edge& edge : edges_) {
        const double value = edge.y * y + edge.constant;  // at x = 0
        if (std::abs(edge.x) * width < margin_) {  // parallel to the row: the same for all samples
          if (value > 2.0 * margin_) last = -1.0;
          if (value > -2.0 * margin_ - edge.band) sure_last = -1.0;
          continue;
        }
        const double may = (margin_ - value) * edge.inverse_x;
        const double sure = (-margin_ - edge.band - value) * edge.inverse_x;
        if (edge.x > 0.0) {
          last = std::min(last, may + kColumnSlack);
          sure_last = std::min(sure_last, sure - kColumnSlack);
        } else {
          first = std::max(first, may - kColumnSlack);
          sure_first = std::max(sure_first, sure + kColumnSlack);
        }
      }
      const auto bounded = [&](double x) {
        return static_cast<int>(std::clamp(x, -2.0, static_cast<double>(width) + 1.0));
      };
      return {bounded(std::ceil(first)), bounded(std::floor(last)), bounded(std::ceil(sure_first)),
              bounded(std::floor(sure_last))};
    }

   private:
    /// Allows for the rounding of the division.
    static constexpr double kColumnSlack = 1e-6;
    struct Edge {
      double x;
      double y;
      double constant;
      double inverse_x;
      double band;
    };
    FixedVector<Edge, 56> edges_;
    double margin_;
  };

  static int first_at_or_after(double y) { return static_cast<int>(std::max(0.0, std::ceil(y))); }
  static int last_at_or_before(double y, int height) {
    return static_cast<int>(std::min(static_cast<double>(height - 1), std::floor(y)));
  }

  const EyeView* view_;
  const PrimaryRays* rays_;
  /// The allowance for the rounding of directions, in rows. An extra row is harmless.
  double row_slack_;
};

}  // namespace beambench::accel::beam
