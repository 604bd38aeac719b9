#include "scenes/base/printable.hpp"

#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "scenes/base/error.hpp"
#include "scenes/base/shell_word.hpp"

namespace beambench {
namespace {

using namespace std::string_literals;

TEST(Printable, LeavesPrintableTextUnchanged) {
  for (const std::string_view text :
       {"", "tetra:n=2", "C\xC3\xA1mara", "\xE6\xBC\xA2\xF0\x9F\x8E\xB2", "back\\slash", "\\x1b",
        "\"quoted\" 'twice'"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, EscapesBytesThatAreNotUtf8) {
  EXPECT_EQ(printable("C\xE1mara"), "C\\xe1mara");
  EXPECT_EQ(printable("cut\xE6\xBC"), "cut\\xe6\\xbc");
  EXPECT_EQ(printable("\xC0\xAF"), "\\xc0\\xaf") << "an overlong encoding";
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
}

TEST(Printable, EscapesControlSequences) {
  EXPECT_EQ(printable("\033[31mred\r\n\t\x07"), "\\x1b[31mred\\x0d\\x0a\\x09\\x07");
  EXPECT_EQ(printable("\0\x7F"s), "\\x00\\x7f");
  EXPECT_EQ(printable("\xC2\x9B"), "\\xc2\\x9b") << "C1";
  EXPECT_EQ(printable("\xE2\x80\xAE\xE2\x81\xA6\xEF\xBB\xBF\xE2\x80\xA8"),
            "\\xe2\\x80\\xae\\xe2\\x81\\xa6\\xef\\xbb\\xbf\\xe2\\x80\\xa8");
}

RC_GTEST_PROP(Printable, IsUtf8AndStaysAsItIs, (const std::string& bytes)) {
  const std::string text = printable(bytes);
  RC_ASSERT(is_utf8(text));
  RC_ASSERT(printable(text) == text);
  for (const unsigned char c : text) RC_ASSERT(c >= 0x20U && c != 0x7FU);
}

TEST(Excerpt, IsTheBeginningOfALongToken) {
  EXPECT_EQ(excerpt(std::string(80, 'x')), std::string(80, 'x'));
  EXPECT_EQ(excerpt(std::string(50'000'000, 'x')), std::string(80, 'x') + "...");
  EXPECT_EQ(excerpt(std::string(79, 'x') + "\xC3\xA1" + "yz"), std::string(79, 'x') + "...")
      << "no half of a character";
}

TEST(MessageLine, KeepsBothEndsOfALongMessage) {
  const std::string line =
      message_line("a.nff:7: '" + std::string(1'000'000, 'x') + "' is not a number;\ncorrect it\n");
  EXPECT_LT(line.size(), 5000U);
  EXPECT_TRUE(line.starts_with("a.nff:7: 'xxx"));
  EXPECT_TRUE(line.ends_with("x' is not a number; correct it"));
  EXPECT_NE(line.find(" ... "), std::string::npos);
}

TEST(MessageLine, IsStoredInErrors) {
  EXPECT_STREQ(InputError("no scene '\033]0;title\x07\xFF'").what(),
               "no scene '\\x1b]0;title\\x07\\xff'");
  EXPECT_STREQ(PluginError("two\nlines").what(), "two lines");
}

TEST(NameOfPath, LeadsBackToThePath) {
  EXPECT_EQ(name_of_path("scenes/balls.nff"), "scenes/balls.nff");
  EXPECT_EQ(name_of_path("bad\xFF.nff"), "bad\\xff.nff");
  EXPECT_EQ(name_of_path("bad\\xff.nff"), "bad\\\\xff.nff") << "another file";
}

RC_GTEST_PROP(NameOfPath, LeadsBackToAnyPath, (const std::string& path)) {
  RC_ASSERT(path_of_name(name_of_path(path)) == path);
  RC_ASSERT(printable(name_of_path(path)) == name_of_path(path));
}

TEST(ShellQuoted, IsPrintable) {
  EXPECT_EQ(shell_quoted("a b"), "'a b'");
  EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_quoted("C\xC3\xA1mara"), "'C\xC3\xA1mara'");
  EXPECT_EQ(shell_quoted("esc\x1B's\\.nff"), "$'esc\\x1b\\'s\\\\.nff'");
}

}  // namespace
}  // namespace beambench
