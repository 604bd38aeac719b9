#include "harness/base/code_folder.hpp"

#include <system_error>

#include <dlfcn.h>
#include <link.h>

namespace beambench::base {

std::filesystem::path code_folder() {
  Dl_info info{};
  link_map* object = nullptr;
  const auto* here = reinterpret_cast<const void*>(&code_folder);
  const bool known =
      ::dladdr1(here, &info, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0;
  // For the program itself, this name is empty, and argv[0] may be relative to another folder.
  const bool is_program = !known || object == nullptr || object->l_name[0] == '\0';
  std::error_code error;
  return std::filesystem::weakly_canonical(is_program ? "/proc/self/exe" : object->l_name, error)
      .parent_path();
}

}  // namespace beambench::base
