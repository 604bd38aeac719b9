#include <array>
#include <filesystem>
#include <string>
#include <system_error>

#include <dlfcn.h>
#include <fmt/format.h>

#include "harness/base/code_folder.hpp"
#include "harness/render/picture/image_encoder.hpp"
#include "scenes/base/error.hpp"

namespace beambench::render {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "libbeambench_image_encoder.so";

EncodeImage* load() {
  const fs::path here = base::code_folder();
  const std::array places{here / kFile, here.parent_path() / "lib/beambench" / kFile};
  for (const fs::path& place : places) {
    std::error_code error;
    if (!fs::exists(place, error)) continue;
    // Never closed, because OpenImageIO registers functions that are called at exit.
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
