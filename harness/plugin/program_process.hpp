#pragma once
// A program that replies to requests. Each request and each reply is one line.

#include <string>

#include <sys/types.h>

namespace beambench::plugin {

/// A process that reads requests from its standard input and writes replies to its standard output.
/// The process is ended with this object.
class ProgramProcess {
 public:
  /// Starts `FILE --beambench 1`. Throws PluginError if that is not possible.
  explicit ProgramProcess(const std::string& file);
  ~ProgramProcess();
  ProgramProcess(const ProgramProcess&) = delete;
  ProgramProcess& operator=(const ProgramProcess&) = delete;

  /// Returns whether requests can be sent: no error has ended the process.
  bool is_running() const { return socket_ >= 0; }
  /// Sends a line and returns the reply. Throws PluginError, and ends the program, if the program
  /// has ended, writes more than one line, or does not reply within `seconds`.
  std::string request(const std::string& line, double seconds);

 private:
  [[noreturn]] void fail(const std::string& problem);
  [[noreturn]] void refuse_more_lines();
  void stop();

  std::string file_;
  int socket_ = -1;
  pid_t process_ = -1;
};

}  // namespace beambench::plugin
