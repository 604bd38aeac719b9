#include "accel/beam/beam_counters.hpp"

namespace beambench::accel::beam {

std::vector<CounterInfo> beam_counters() {
  return {
      {"beams", "leaves entered by a beam, and beams that leave the root"},
      {"beams_nonterminal", "of these: empty leaves"},
      {"beams_occupied", "of these: occupied leaves, where the beam's samples become rays"},
      {"beams_leaving", "of these: beams that leave the root"},
      {"beams_nonterminal_ns", "nanoseconds of the counting pass spent in empty leaves"},
      {"beams_occupied_ns", "nanoseconds of the counting pass spent in occupied leaves"},
      {"beams_leaving_ns", "nanoseconds of the counting pass spent on beams that leave the root"},
      {"beams_made",
       "beams as the thesis counts them: initial beams, and each part of a divided beam"},
      {"beams_divided", "beams that were divided into two or more parts"},
      {"beams_passed_whole", "times that a beam continued undivided"},
      {"beam_edges", "edges of the polygons of all beams"},
      {"beam_clips", "cuts of a polygon by a line"},
      {"neighbor_searches", "searches by beams for the leaf behind a face"},
      {"samples_leaving", "samples that left the root with a beam"},
      {"samples_in_leaves", "samples that were tested in a leaf with a beam"},
      {"rays_after_leaf", "samples that found no hit in their beam's leaf and continued as rays"},
      {"rays_by_handover",
       "samples that became rays because their beam had fewer samples than 'handover', or few "
       "rays that a plane reflects or refracts"},
      {"rays_by_crowding", "samples that became rays because their beam had too many cuts"},
      {"rays_beside_beams",
       "rays that a plane reflected or refracted and that are in no beam, because they deviate "
       "too much from their neighbors or are too few"},
  };
}

}  // namespace beambench::accel::beam
