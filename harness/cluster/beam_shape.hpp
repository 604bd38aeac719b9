#pragma once
// The cross-section of a beam as bytes.

#include "accel/beam/beam.hpp"
#include "harness/cluster/bytes.hpp"

namespace beambench::cluster {

/// A plane of the cells: five bytes.
void write_crossing(const accel::beam::Crossing& crossing, ByteWriter& writer);
/// Throws ProtocolError where the grid has no such plane.
accel::beam::Crossing read_crossing(const accel::CellGrid& grid, ByteReader& reader);

/// Outline and cuts. Of the cuts only the planes are told, for their lines follow from them.
void write_shape(const accel::beam::Beam& beam, ByteWriter& writer);
/// Back again, bit for bit. Throws ProtocolError for what is no beam.
void read_shape(ByteReader& reader, const accel::beam::EyeView& view, accel::beam::Beam& beam);

}  // namespace beambench::cluster
