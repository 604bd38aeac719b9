#pragma once
// What every program does first.

namespace beambench::base {

/// Makes failures of output errors of the functions that write, which are reported, in place of
/// signals and of files that take the place of a stream:
/// - a standard stream that is closed is opened on /dev/null (the standard output so that writing
///   to it fails), since the next file to be opened would otherwise become that stream;
/// - a file that reaches the limit of its size (`ulimit -f`) fails to be written (EFBIG), where
///   SIGXFSZ would end the process without a word.
/// Call it before anything is opened.
void prepare_process();

}  // namespace beambench::base
