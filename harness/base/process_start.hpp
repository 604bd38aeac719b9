#pragma once
// The first function that every program calls.

namespace beambench::base {

/// Makes output failures appear as errors of the writing functions, which are reported. Otherwise
/// they could appear as signals, or a file could take the place of a stream:
/// - Opens /dev/null on a closed standard stream (standard output such that writing to it fails);
///   otherwise, the next file opened would become that stream.
/// - Makes writing to a file fail with EFBIG when the file reaches the size limit (`ulimit -f`);
///   otherwise, SIGXFSZ would end the process without a message.
/// Call it before opening any file.
void prepare_process();

}  // namespace beambench::base
