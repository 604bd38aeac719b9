#include "scenes/base/files.hpp"

#include <array>
#include <filesystem>
#include <ostream>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include "scenes/base/error.hpp"
#include "scenes/formats/nff/nff_reader.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::scenes {
namespace {

namespace fs = std::filesystem;

/// A pseudoterminal: text written at one end can be read at the other. When the first end is
/// closed, reading fails with an input error (EIO), as with a failing disk.
class HungUpTerminal {
 public:
  explicit HungUpTerminal(const std::string& text) : reader_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    if (reader_ < 0 || ::grantpt(reader_) != 0 || ::unlockpt(reader_) != 0) return;
    const int writer = ::open(::ptsname(reader_), O_RDWR | O_NOCTTY);
    termios settings{};
    works_ = writer >= 0 && ::tcgetattr(writer, &settings) == 0;
    ::cfmakeraw(&settings);  // line ends are not converted
    works_ = works_ && ::tcsetattr(writer, TCSANOW, &settings) == 0 &&
             ::write(writer, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    ::close(writer);
  }
  ~HungUpTerminal() { ::close(reader_); }
  HungUpTerminal(const HungUpTerminal&) = delete;
  HungUpTerminal& operator=(const HungUpTerminal&) = delete;

  bool works() const { return works_; }
  int descriptor() const { return reader_; }

 private:
  int reader_;
  bool works_ = false;
};

TEST(Input, AByteOrderMarkOfATextIsSkipped) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("a", "\xEF\xBB\xBFone\n\xEF\xBB\xBFtwo");
  EXPECT_EQ(read_text_input(file, kLargestFile), "one\n\xEF\xBB\xBFtwo");
  EXPECT_EQ(read_input(file, kLargestFile), "\xEF\xBB\xBFone\n\xEF\xBB\xBFtwo")
      << "bytes are not text";
  InputStream lines(file);
  EXPECT_EQ(lines.line(), "one");
  EXPECT_EQ(lines.line(), "\xEF\xBB\xBFtwo");
}

TEST(Input, IsReadWhole) {
  const TemporaryFolder folder;
  std::string text(300000, 'x');
  text[70000] = '\0';
  EXPECT_EQ(read_input(folder.write("a", text), kLargestFile), text);
  EXPECT_EQ(read_input(folder.write("empty", ""), 0), "");
  EXPECT_EQ(read_input("/dev/null", 0), "");
  EXPECT_FALSE(read_input("/proc/self/status", kLargestFile).empty())
      << "a file that does not report its length";
}

TEST(Input, ComesThroughPipes) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  ASSERT_EQ(::write(ends[1], "s 0 0 0 1\n", 10), 10);
  ::close(ends[1]);
  EXPECT_EQ(read_input("/dev/fd/" + std::to_string(ends[0]), kLargestFile), "s 0 0 0 1\n");
  ::close(ends[0]);
}

TEST(Input, IsReadFromADescriptorsPosition) {
  const TemporaryFolder folder;
  const int file = ::open(folder.write("a", "0123456789").c_str(), O_RDONLY);
  ASSERT_EQ(::lseek(file, 4, SEEK_SET), 4);
  EXPECT_EQ(read_input(file, "a", kLargestFile), "456789");
  EXPECT_EQ(read_input(file, "a", kLargestFile), "") << "at the end";
  ::close(file);
}

TEST(Input, TruncatedByAnInputErrorIsRefused) {
  EXPECT_TRUE(says(thrown_message([] { read_input("/proc/self/mem", kLargestFile); }),
                   {"/proc/self/mem: cannot be read: Input/output error"}));
  const HungUpTerminal terminal("s 0 0 0 1\n");
  if (!terminal.works()) GTEST_SKIP() << "this system has no pseudoterminals";
  EXPECT_TRUE(
      says(thrown_message([&] { read_input(terminal.descriptor(), "a.nff", kLargestFile); }),
           {"a.nff: cannot be read: Input/output error"}));
}

TEST(Input, OfAnotherFormatIsRefused) {
  const TemporaryFolder folder;
  EXPECT_TRUE(says(thrown_message([] { read_input("/no/such/file", kLargestFile); }),
                   {"/no/such/file: cannot be read: No such file or directory", "check the path"}));
  EXPECT_TRUE(says(thrown_message([&] { read_input(folder.path(), kLargestFile); }),
                   {folder.path().string() + ": cannot be read: it is a folder"}));
  const std::string file = folder.write("a", "12345").string();
  EXPECT_EQ(read_input(file, 5), "12345");
  EXPECT_TRUE(says(thrown_message([&] { read_input(file, 4); }),
                   {file + ": cannot be read: it holds more than 4 bytes"}));
  EXPECT_TRUE(says(thrown_message([] { read_input("/dev/zero", 1U << 20U); }),
                   {"/dev/zero: cannot be read: it holds more than 1048576 bytes"}));
}

TEST(Input, OfADeviceIsBoundedWhateverTheKindOfFile) {
  EXPECT_TRUE(says(thrown_message([] { read_input("/dev/zero", kLargestFile); }),
                   {"/dev/zero: cannot be read: it holds more than 67108864 bytes"}));
  EXPECT_TRUE(says(thrown_message([] { nff::read_nff("/dev/zero"); }),
                   {"/dev/zero: cannot be read: it holds more than 67108864 bytes"}));
}

TEST(Input, IsNotWaitedForAtANamedPipe) {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(says(thrown_message([&] { read_input(pipe, kLargestFile); }),
                   {"it is a pipe into which nothing is written"}));
}

TEST(Input, OfASceneIsRefusedInTheSameWords) {
  EXPECT_TRUE(says(thrown_message([] { nff::read_nff("/proc/self/mem"); }),
                   {"/proc/self/mem: cannot be read: Input/output error"}));
}

TEST(Output, IsInvisibleUntilItIsComplete) {
  const TemporaryFolder folder;
  const fs::path target = folder.write("a.txt", "old");
  const auto fail_half_way = [&](std::ostream& file) {
    file << "new" << std::flush;
    EXPECT_EQ(read_text(target), "old");
    for (const auto& entry : fs::directory_iterator(folder.path())) {
      EXPECT_EQ(entry.path().extension(), ".txt");
      EXPECT_EQ(is_left_behind(entry.path()), entry.path() != target);
    }
    throw InputError("half way");
  };
  EXPECT_THROW(write_file(target, fail_half_way), InputError);
  EXPECT_EQ(read_text(target), "old") << "unfinished output changes nothing";
  write_file(target, "new");
  EXPECT_EQ(read_text(target), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

TEST(Output, IsRefusedWhereNoFileCanExist) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("a.txt", "");
  for (const fs::path& target :
       {folder.path(), folder.path() / "missing" / "b.txt", file / "b.txt", fs::path("/proc/b")}) {
    EXPECT_THROW(write_file(target, "text"), InputError) << target;
  }
}

}  // namespace
}  // namespace beambench::scenes
