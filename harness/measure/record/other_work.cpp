#include "harness/measure/record/other_work.hpp"

#include <algorithm>
#include <fstream>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

namespace beambench::measure {
namespace {

constexpr std::chrono::duration<double> kLeastTime{0.4};

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double seconds_used(int who) {
  rusage used{};
  ::getrusage(who, &used);
  return seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
}

/// Returns the time in which the processors worked: user, nice, system, irq and softirq.
std::optional<double> busy_seconds(const std::filesystem::path& stat) {
  std::ifstream file(stat);
  std::string name;
  double user{}, nice{}, system{}, idle{}, iowait{}, irq{}, softirq{};
  if (!(file >> name >> user >> nice >> system >> idle >> iowait >> irq >> softirq)) return {};
  return (user + nice + system + irq + softirq) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

}  // namespace

OtherWork::OtherWork(const std::filesystem::path& root) : root_(root) {}

std::optional<double> OtherWork::processors() const {
  const Reading now = read();
  const std::chrono::duration<double> passed = now.when - begin_.when;
  if (passed < kLeastTime || !begin_.all || !now.all) return std::nullopt;
  const double others = (*now.all - *begin_.all) - (now.own - begin_.own);
  return std::max(others, 0.0) / passed.count();
}

OtherWork::Reading OtherWork::read() const {
  return {std::chrono::steady_clock::now(), busy_seconds(root_ / "proc/stat"),
          seconds_used(RUSAGE_SELF) + seconds_used(RUSAGE_CHILDREN)};
}

}  // namespace beambench::measure
