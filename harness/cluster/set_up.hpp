#pragma once
// How a process begins: who cannot set up says so, and nobody waits for him.

#include <functional>
#include <new>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "harness/cluster/transport.hpp"
#include "scenes/core/error.hpp"

namespace beambench::cluster {

/// On process 0: does what `set_up` does, whose warnings go to stderr. Whatever it throws, the
/// others are told the end before.
void set_up_to_lead(Transport& transport,
                    const std::function<void(std::vector<std::string>& warnings)>& set_up);

/// Tells process 0 what keeps this process from working, and waits for the end.
void excuse(Transport& transport, const std::string& problem);

/// On the others: what `set_up` gives; nothing where it could not be done (InputError, or no
/// memory), process 0 was told why and has ended the run.
template <class SetUp>
std::optional<std::invoke_result_t<SetUp>> set_up_to_follow(Transport& transport, SetUp set_up) {
  std::string problem;
  try {
    return set_up();
  } catch (const InputError& error) {
    problem = error.what();
  } catch (const std::bad_alloc&) {
    problem = "the memory does not suffice for this scene";
  }
  excuse(transport, problem);
  return std::nullopt;
}

}  // namespace beambench::cluster
