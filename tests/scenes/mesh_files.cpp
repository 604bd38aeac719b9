#include "tests/scenes/mesh_files.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "tests/scenes/put.hpp"

namespace beambench::scenes {
namespace {

using tests::put;

constexpr std::array<std::array<float, 3>, 4> kTetrahedron = {
    {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 2.0F, 0.0F}, {0.0F, 0.0F, 3.0F}}};
constexpr std::array<std::array<std::uint32_t, 3>, 4> kFaces = {
    {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};

std::string corner_lines(std::string_view before) {
  std::string text;
  for (const auto& [x, y, z] : kTetrahedron) text += fmt::format("{}{} {} {}\n", before, x, y, z);
  return text;
}

std::string face_lines(std::string_view before, std::uint32_t first) {
  std::string text;
  for (const auto& [a, b, c] : kFaces) {
    text += fmt::format("{}{} {} {}\n", before, a + first, b + first, c + first);
  }
  return text;
}

std::string ply_header(std::string_view format) {
  return fmt::format(
      "ply\nformat {} 1.0\ncomment made for a test\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\nelement face 4\n"
      "property list uchar int vertex_indices\nend_header\n",
      format);
}

}  // namespace

std::string tetrahedron_obj() { return corner_lines("v ") + face_lines("f ", 1); }

std::string tetrahedron_off() { return "OFF\n4 4 0\n" + corner_lines("") + face_lines("3 ", 0); }

std::string tetrahedron_ply() {
  return ply_header("ascii") + corner_lines("") + face_lines("3 ", 0);
}

std::string tetrahedron_binary_ply() {
  std::string bytes = ply_header("binary_little_endian");
  for (const auto& corner : kTetrahedron) put(bytes, corner);
  for (const auto& face : kFaces) {
    put(bytes, std::uint8_t{3});
    put(bytes, face);
  }
  return bytes;
}

std::string tetrahedron_stl() {
  std::string text = "solid test\n";
  for (const auto& face : kFaces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t i : face) {
      text += fmt::format("vertex {} {} {}\n", kTetrahedron[i][0], kTetrahedron[i][1],
                          kTetrahedron[i][2]);
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid test\n";
}

std::string tetrahedron_binary_stl() {
  std::string bytes(80, ' ');
  put(bytes, std::uint32_t{4});
  for (const auto& face : kFaces) {
    put(bytes, std::array<float, 3>{});
    for (const std::uint32_t i : face) put(bytes, kTetrahedron[i]);
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string tetrahedron_gltf() {
  std::string buffer;
  for (const auto& corner : kTetrahedron) put(buffer, corner);
  for (const auto& face : kFaces) put(buffer, face);
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
      R"("buffers":[{{"byteLength":96,"uri":"data:application/octet-stream;base64,{}"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":48}},)"
      R"({{"buffer":0,"byteOffset":48,"byteLength":48}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3",)"
      R"("min":[0,0,0],"max":[1,2,3]}},)"
      R"({{"bufferView":1,"componentType":5125,"count":12,"type":"SCALAR"}}]}})",
      base64(buffer));
}

std::string tetrahedron_ac() {
  std::string text =
      "AC3Db\nMATERIAL \"m\" rgb 1 0 0 amb 1 1 1 emis 0 0 0 spec 0 0 0 shi 0 trans 0\n"
      "OBJECT world\nkids 1\nOBJECT poly\nname \"a\"\nnumvert 4\n" +
      corner_lines("") + "numsurf 4\n";
  for (const auto& [a, b, c] : kFaces) {
    text += fmt::format("SURF 0x10\nmat 0\nrefs 3\n{} 0 0\n{} 0 0\n{} 0 0\n", a, b, c);
  }
  return text + "kids 0\n";
}

std::vector<std::pair<std::string, std::string>> tetrahedron_files() {
  return {{"text.obj", tetrahedron_obj()},   {"text.off", tetrahedron_off()},
          {"text.ply", tetrahedron_ply()},   {"binary.ply", tetrahedron_binary_ply()},
          {"text.stl", tetrahedron_stl()},   {"binary.stl", tetrahedron_binary_stl()},
          {"text.gltf", tetrahedron_gltf()}, {"text.ac", tetrahedron_ac()}};
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8U | (j < count ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += j <= count ? kDigits[group >> (18U - 6U * j) & 63U] : '=';
    }
  }
  return text;
}

std::string with_count(std::string text, const std::string& old, const std::string& by) {
  return text.replace(text.find(old), old.size(), by);
}

std::string with_coordinate(std::string text, const std::string& number) {
  return with_count(std::move(text), "1 0 0\n", number + " 0 0\n");
}

}  // namespace beambench::scenes
