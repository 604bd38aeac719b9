#pragma once
// The first call of every program.

namespace beambench::base {

/// Turns output failures into errors of the writing functions, which are reported, instead of
/// signals or files that replace a stream:
/// - a closed standard stream is opened on /dev/null (the standard output such that writing
///   to it fails), since the next file to be opened would otherwise become that stream;
/// - a file that reaches the limit of its size (`ulimit -f`) fails to be written (EFBIG), where
///   SIGXFSZ would end the process without a word.
/// Call it before anything is opened.
void prepare_process();

}  // namespace beambench::base
