#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scenes/base/process_memory.hpp"
#include "scenes/base/random.hpp"
#include "tests/ply_file.hpp"
#include "tests/scenes/imported.hpp"
#include "tests/scenes/ply_parts.hpp"

namespace beambench::scenes {
namespace {

using namespace ply_parts;
using tests::kPlyEncodings;

TEST(PlyRows, AnInvalidNumberIsRefusedWithItsLine) {
  for (const char* word : {"1.#QNAN", "-1.#IND", "1,5", "0x10", "1e", "1.2.3", "--1", "+-1", "x",
                           "1d5", "1_000", "1f"}) {
    EXPECT_TRUE(says(ply_refusal(triangle_ply(fmt::format("0 {} 0", word))),
                     {"a.ply: line 10: vertex 0: ", fmt::format("'{}'", word), "type float"}));
  }
  EXPECT_TRUE(says(ply_refusal(triangle_ply("nan 0 0")), {"coordinate nan", "1e9"}));
  EXPECT_TRUE(says(ply_refusal(triangle_ply("1e999 0 0")), {"coordinate inf", "1e9"}));
}

TEST(PlyRows, EveryNotationOfNumbersIsRead) {
  for (const char* word : {"0.5", ".5", "+.5", "5e-1", "5E-01", "0.50000000000000000000", "+0.5"}) {
    const auto mesh = imported(triangle_ply(fmt::format("{} 0 0", word)), "ply");
    EXPECT_EQ(triangles_of(mesh)[0][0], glm::vec3(0.5F, 0.0F, 0.0F)) << word;
  }
}

TEST(PlyRows, RowsThatAreTooShortOrTooLongAreRefused) {
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0")), {"line 10: vertex 0: the line ends before"}));
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0 7")), {"line 10: vertex 0: '7' follows"}));
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0", "3 0 1")), {"line 13: face 0: ", "ends"}));
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0", "3 0 1 2 0")), {"face 0: '0' follows"}));
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0", "-3 0 1 2")), {"'-3'", "type uchar"}));
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0", "259 0 1 2")), {"'259'", "type uchar"}));
  EXPECT_NO_THROW(imported(triangle_ply("\n0 0 0\n", "\n\n3 0 1 2\n \n"), "ply")) << "empty lines";
}

TEST(PlyRows, MissingVerticesAreRefused) {
  for (const char* index : {"3", "-1", "2147483647"}) {
    EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0", fmt::format("3 0 1 {}", index))),
                     {"line 13: face 0: ", fmt::format("refers to vertex {},", index), "only 3"}));
  }
  for (const char* index : {"4294967298", "1.5", "1e0", "1,"}) {
    EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0", fmt::format("3 0 1 {}", index))),
                     {"line 13: face 0: ", fmt::format("'{}'", index), "type int"}));
  }
  const std::string real = ply_file("ascii", vertices(3) + faces(1, "uchar float"), {});
  for (const char* index : {"1.5", "nan", "inf", "1e30"}) {
    EXPECT_TRUE(says(ply_refusal(real + "0 0 0\n1 0 0\n0 1 0\n3 0 1 " + index + "\n"),
                     {"line 13: face 0: ", "not a vertex index"}));
  }
  for (const std::string_view encoding : {kPlyEncodings[1], kPlyEncodings[2]}) {
    const std::string bytes = ply_file(
        encoding, vertices(4) + faces(1, "uchar uint"),
        corners() +
            std::vector<PlyRow>{{{"uchar", 3}, {"uint", 0}, {"uint", 1}, {"uint", 4294967295.0}}});
    EXPECT_TRUE(says(ply_refusal(bytes), {fmt::format("byte {}: face 0: ", bytes.size()),
                                          "refers to vertex 4294967295", "only 4"}));
  }
}

TEST(PlyRows, AListOfNegativeLengthIsRefused) {
  for (const std::string_view encoding : kPlyEncodings) {
    EXPECT_TRUE(says(ply_refusal(ply_file(encoding, vertices(4) + faces(1, "char int"),
                                          corners() + std::vector<PlyRow>{{{"char", -1}}})),
                     {"face 0: ", "length -1"}));
  }
}

TEST(PlyRows, AFileTruncatedAnywhereIsRefused) {
  for (const std::string_view encoding : kPlyEncodings) {
    const std::string bytes =
        ply_file(encoding, vertices(4) + faces(4), corners() + tetrahedron_faces());
    const std::size_t last = bytes.size() - (encoding == "ascii" ? 1 : 0);  // the last line's end
    for (std::size_t size = 0; size < last; ++size) {
      EXPECT_NE(ply_refusal(bytes.substr(0, size)), "(nothing thrown)") << encoding << ' ' << size;
    }
  }
}

TEST(PlyRows, WhatFollowsTheLastRowIsRefused) {
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0") + "3 0 1 2\n"),
                   {"a.ply: line 14: '3' follows the last row"}));
  const std::string bytes =
      ply_file("binary_big_endian", vertices(4) + faces(4), corners() + tetrahedron_faces());
  EXPECT_TRUE(says(ply_refusal(bytes + '\n'),
                   {fmt::format("a.ply: byte {}: one byte follows", bytes.size())}));
  EXPECT_TRUE(says(ply_refusal(bytes + "end"), {"3 bytes follow"}));
}

TEST(PlyRows, AHugeCountAllocatesNoMemory) {
  for (const std::string_view encoding : kPlyEncodings) {
    for (const char* types : {"uchar int", "uint int"}) {
      for (const std::string& declarations :
           {vertices(4) + faces(4'000'000'000'000, types), vertices(4'000'000'000'000) + faces(4),
            "element a 4000000000000\nproperty list uint double b\n" + vertices(4) + faces(4)}) {
        std::string message;
        const auto growth = peak_memory_growth([&] {
          message = ply_refusal(ply_file(
              encoding, declarations, corners() + std::vector<PlyRow>{{{"uint", 4294967295.0}}}));
        });
        EXPECT_NE(message, "(nothing thrown)");
        EXPECT_LT(growth.value_or(0), std::uint64_t{16} << 20U) << message;
      }
    }
  }
}

// Numbers

/// Assimp issue 3573: up to a fifth of the coordinates were off by one or two units.
TEST(PlyRows, CoordinatesAreTheNearestFloats) {
  EXPECT_EQ(triangles_of(imported(triangle_ply("0.000000000000000123456 0 0"), "ply"))[0][0].x,
            0.000000000000000123456F);
  Random random(3573);
  for (int i = 0; i < 2000; ++i) {
    const auto digits = static_cast<int>(1 + random.below(20));
    const std::string text = fmt::format(
        "{:.{}g}", (random.unit() - 0.5) * std::pow(10.0, random.unit() * 16.0 - 8.0), digits);
    const auto mesh = imported(triangle_ply(text + " 5e8 7"), "ply");
    EXPECT_EQ(triangles_of(mesh)[0][0].x, std::strtof(text.c_str(), nullptr)) << text;
  }
}

/// A decimal that is first rounded to double would always become the even of two floats.
TEST(PlyRows, AFloatIsRoundedOnce) {
  const auto x = [](const std::string& text) {
    return triangles_of(imported(triangle_ply(text + " 0 0"), "ply"))[0][0].x;
  };
  EXPECT_EQ(x("0.5000000298023223876953125"), 0.5F) << "a tie is rounded to the even float";
  EXPECT_EQ(x("0.50000002980232238769531250000000000000001"), 0x1.000002p-1F);
  EXPECT_EQ(x("0.50000002980232238769531249999999999999999"), 0.5F);
}

/// Includes doubles halfway between two floats.
TEST(PlyRows, DoublesAreTheSameInTextAndInBinary) {
  Random random(17);
  const auto drawn = [&] {
    const auto bits = static_cast<std::uint32_t>(random.below(0x4e000000));  // 0 to some 5e8
    const auto value = static_cast<double>(std::bit_cast<float>(bits));
    const auto next = static_cast<double>(std::bit_cast<float>(bits + 1));
    const double middle = 0.5 * (value + next);
    return random.unit() < 0.5 ? middle : middle * (1.0 + 1e-15 * (random.unit() - 0.5));
  };
  for (int i = 0; i < 500; ++i) {
    const double value = drawn();
    const auto rows = [&](const std::string& text) {
      std::vector<PlyRow> rows = corners("double");
      rows[1][0] = {"double", value, text};
      return rows + tetrahedron_faces();
    };
    const std::string declarations = vertices(4, "double") + faces(4);
    if (!(value > 1e-6)) continue;  // a tetrahedron without volume
    const std::uint64_t hash = ply_hash(ply_file(kPlyEncodings[1], declarations, rows("")));
    EXPECT_EQ(ply_hash(ply_file(kPlyEncodings[2], declarations, rows(""))), hash);
    EXPECT_EQ(ply_hash(ply_file("ascii", declarations, rows(""))), hash) << value;
    EXPECT_EQ(ply_hash(ply_file("ascii", declarations, rows(fmt::format("{:.17g}", value)))), hash);
  }
}

TEST(PlyRows, AMeshWithoutNumbersBeyondTheLimitIsReadWhateverUnusedVerticesHold) {
  const std::string text = ply_file("ascii", vertices(4) + faces(1), {}) +
                           "0 0 0\n1 0 0\n0 1 0\nnan inf 1e30\n3 0 1 2\n";
  EXPECT_EQ(imported(text, "ply").mesh.vertices.size(), 3U);
}

}  // namespace
}  // namespace beambench::scenes
