#pragma once
// Parts of PLY files that contain a tetrahedron.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "tests/ply_file.hpp"
#include "tests/scenes/imported.hpp"

namespace beambench::scenes::ply_parts {

using tests::ply_file;
using tests::PlyRow;

/// Returns the header lines for vertices.
inline std::string vertices(std::size_t count, std::string_view type = "float") {
  return fmt::format("element vertex {}\nproperty {} x\nproperty {} y\nproperty {} z\n", count,
                     type, type, type);
}

/// Returns the header lines for faces.
inline std::string faces(std::size_t count, std::string_view types = "uchar int") {
  return fmt::format("element face {}\nproperty list {} vertex_indices\n", count, types);
}

/// Returns the corners of a tetrahedron (0,0,0), (1,0,0), (0,2,0), (0,0,3).
inline std::vector<PlyRow> corners(std::string_view type = "float") {
  return {{{type, 0}, {type, 0}, {type, 0}},
          {{type, 1}, {type, 0}, {type, 0}},
          {{type, 0}, {type, 2}, {type, 0}},
          {{type, 0}, {type, 0}, {type, 3}}};
}

/// Returns a row that is one list.
inline PlyRow list(std::string_view length_type, std::string_view type,
                   const std::vector<int>& numbers) {
  PlyRow row = {{length_type, static_cast<double>(numbers.size())}};
  for (const int number : numbers) row.push_back({type, static_cast<double>(number)});
  return row;
}

inline const std::vector<std::vector<int>> kTetrahedronFaces = {
    {0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

inline std::vector<PlyRow> tetrahedron_faces(std::string_view length_type = "uchar",
                                             std::string_view type = "int") {
  std::vector<PlyRow> rows;
  for (const auto& face : kTetrahedronFaces) rows.push_back(list(length_type, type, face));
  return rows;
}

/// Concatenates rows.
inline std::vector<PlyRow> operator+(std::vector<PlyRow> rows, const std::vector<PlyRow>& more) {
  rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

/// Returns a text file with three vertices, the first of which is given, and a triangle.
inline std::string triangle_ply(const std::string& first, const std::string& face = "3 0 1 2") {
  return ply_file("ascii", vertices(3) + faces(1), {}) + first + "\n1 0 0\n0 1 0\n" + face + "\n";
}

inline std::uint64_t ply_hash(const std::string& bytes) { return imported_hash(bytes, "ply"); }

inline std::string ply_refusal(const std::string& bytes) { return refusal(bytes, "ply"); }

}  // namespace beambench::scenes::ply_parts
