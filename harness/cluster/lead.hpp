#pragma once
// A whole run as process 0 has it, and as the others have it.

#include "harness/cluster/report_file.hpp"
#include "harness/cluster/request.hpp"
#include "harness/cluster/transport.hpp"

namespace beambench::cluster {

/// Makes the image and writes the files that were asked for, after the job was broadcast. Throws
/// InputError where the scene cannot be had or a process does not fit; the others are told the end
/// before.
ClusterRun lead(const ClusterRequest& request, Transport& transport);

/// Is told the job and works on it to its end. What keeps this process from working is told to
/// process 0, which ends the run.
void follow(Transport& transport);

}  // namespace beambench::cluster
