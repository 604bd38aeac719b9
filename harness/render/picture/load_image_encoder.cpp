#include <array>
#include <filesystem>
#include <string>
#include <system_error>

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include "harness/render/picture/image_encoder.hpp"
#include "scenes/core/error.hpp"

namespace beambench::render {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "libbeambench_image_encoder.so";

/// The folder of the program or shared object that this code was linked into.
fs::path folder_of_this_code() {
  Dl_info info{};
  link_map* object = nullptr;
  const auto* here = reinterpret_cast<const void*>(&folder_of_this_code);
  const bool known =
      ::dladdr1(here, &info, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0;
  // The program itself has no name there, and that of its call may be relative to another folder.
  const bool is_program = !known || object == nullptr || object->l_name[0] == '\0';
  std::error_code error;
  return fs::weakly_canonical(is_program ? "/proc/self/exe" : object->l_name, error).parent_path();
}

EncodeImage* load() {
  const fs::path here = folder_of_this_code();
  const std::array places{here / kFile, here.parent_path() / "lib/beambench" / kFile};
  for (const fs::path& place : places) {
    std::error_code error;
    if (!fs::exists(place, error)) continue;
    // Never closed: what OpenImageIO registers is called when the program ends.
    void* object = ::dlopen(place.c_str(), RTLD_LAZY | RTLD_LOCAL);
    void* function = object == nullptr ? nullptr : ::dlsym(object, kEncodeImage);
    if (function != nullptr) return reinterpret_cast<EncodeImage*>(function);
    const char* why = ::dlerror();
    throw InputError(
        fmt::format("pictures cannot be written: {} cannot be loaded ({}); build or install again",
                    place.string(), why == nullptr ? "no reason was given" : why));
  }
  throw InputError(fmt::format(
      "pictures cannot be written: {} is neither beside the program nor {}; build or install again",
      kFile, places.back().string()));
}

}  // namespace

EncodeImage& image_encoder() {
  static EncodeImage* const function = load();
  return *function;
}

}  // namespace beambench::render
