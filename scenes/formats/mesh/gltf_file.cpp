// tinygltf is compiled here, without the code that reads images.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE

#include "scenes/formats/mesh/gltf_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <exception>
#include <limits>
#include <new>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/base/error.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"

namespace beambench::scenes::mesh {
namespace {

/// Prefixes of extensions that affect only the appearance, or are supported. If any other required
/// extension were ignored, the shape would be different.
constexpr std::array<std::string_view, 9> kHarmless = {
    "KHR_materials_", "KHR_texture_",          "EXT_texture_",
    "MSFT_texture_",  "KHR_lights_",           "EXT_lights_",
    "KHR_xmp",        "KHR_mesh_quantization", "KHR_animation_pointer"};

void require_known_extensions(const tinygltf::Model& model) {
  for (const std::string& name : model.extensionsRequired) {
    const bool harmless =
        std::any_of(kHarmless.begin(), kHarmless.end(),
                    [&](std::string_view start) { return name.starts_with(start); });
    if (harmless) continue;
    throw InputError(
        fmt::format("it requires the extension '{}', which is not supported; export it without "
                    "that extension, for example without compression",
                    name));
  }
}

/// Returns tinygltf's messages as one clause.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  constexpr std::size_t kLongest = 300;  // the text may contain a data URI
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text.empty() ? "no reason is known" : text;
}

/// Returns the JSON text of a .gltf or .glb file whose header tinygltf has accepted.
std::string_view json_text_of(std::string_view bytes) {
  constexpr std::size_t kLengthAt = 12;  // glTF 2.0, 4.4: after magic, version and length
  constexpr std::size_t kTextAt = 20;    // after the chunk's type
  if (!bytes.starts_with("glTF")) return bytes;
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + kLengthAt, sizeof(length));
  return bytes.substr(kTextAt, length);
}

/// Returns the URIs of the buffers that are files, in the order in which tinygltf reads them.
std::vector<std::string> uris_of_buffer_files(std::string_view bytes) {
  using Json = nlohmann::json;
  const auto keep = [](int depth, Json::parse_event_t event, const Json& parsed) {
    return depth != 1 || event != Json::parse_event_t::key || parsed == "buffers";
  };
  const Json json = Json::parse(json_text_of(bytes), keep);
  std::vector<std::string> uris;
  for (const Json& buffer : json.value("buffers", Json::array())) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    auto uri = buffer["uri"].get<std::string>();
    if (!uri.empty() && !tinygltf::IsDataURI(uri)) uris.push_back(std::move(uri));
  }
  return uris;
}

/// Returns the string with each `%HH` decoded (RFC 3986, 2.1).
std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (; !text.empty(); text.remove_prefix(1)) {
    std::uint8_t byte = 0;
    const char* const digits = text.data() + 1;
    if (text[0] == '%' && text.size() > 2 &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      decoded += static_cast<char>(byte);
      text.remove_prefix(2);
    } else {
      decoded += text[0];
    }
  }
  return decoded;
}

/// The state of the callbacks that read files for tinygltf: the file itself, its companions, how
/// many buffers were read, and why one of them was refused.
struct Buffers {
  std::string_view file;
  MeshCompanions* companions;
  std::vector<std::string> uris{};
  std::size_t read = 0;
  std::optional<std::string> refusal{};

  /// Returns the name of the next buffer's file. tinygltf provides it too, but replaces '+' with a
  /// blank and decodes anything after a '%'. Some exporters write names unencoded, such as
  /// Blender's '%'.
  std::string next_name() {
    if (read == 0) uris = uris_of_buffer_files(file);
    const std::string& uri = uris.at(read++);
    std::string decoded = percent_decoded(uri);
    return !companions->has(decoded) && companions->has(uri) ? uri : decoded;
  }
};

bool read_buffer(std::vector<unsigned char>* bytes, std::string* error, const std::string&,
                 void* user) {
  Buffers& buffers = *static_cast<Buffers*>(user);
  try {
    const std::string name = buffers.next_name();
    const std::string_view read = buffers.companions->read(name);
    bytes->assign(read.begin(), read.end());
    buffers.companions->release(name);
    return true;
  } catch (const InputError& refusal) {
    buffers.refusal = refusal.what();
    *error = refusal.what();
    return false;
  }
}

/// Returns the callbacks. Files are tested for existence only when they are read, and only in the
/// mesh file's own folder.
tinygltf::FsCallbacks callbacks(Buffers& buffers) {
  tinygltf::FsCallbacks files{};
  files.FileExists = [](const std::string& name, void*) { return !name.empty(); };
  files.ExpandFilePath = [](const std::string& name, void*) { return name; };
  files.ReadWholeFile = read_buffer;
  files.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                            void*) { return false; };
  files.user_data = &buffers;
  return files;
}

/// Newer versions of tinygltf request the size before they read.
template <typename Callbacks>
void add_size_callback(Callbacks& files) {
  if constexpr (requires { files.GetFileSizeInBytes; }) {
    files.GetFileSizeInBytes = [](std::size_t* size, std::string*, const std::string&, void*) {
      *size = 1;  // the companions have their own limit
      return true;
    };
  }
}

/// Returns the size of the buffers embedded in a .gltf file's text. (A .glb's own buffer is part of
/// the file.)
std::size_t decoded_bytes(const tinygltf::Model& model) {
  std::size_t total = 0;
  for (const tinygltf::Buffer& buffer : model.buffers) {
    if (buffer.uri.starts_with("data:")) total += buffer.data.size();
  }
  return total;
}

}  // namespace

void refuse_gltf(std::string_view why) {
  throw InputError(fmt::format("it cannot be read as a mesh ({}); export it again", why));
}

void refuse_index(int index, std::size_t size, std::string_view what, std::string_view user) {
  refuse_gltf(fmt::format("{} refers to {} {}, but the file has only {}", user, what, index, size));
}

tinygltf::Model read_gltf(std::string_view bytes, MeshCompanions& companions) {
  constexpr std::uint64_t kLargest = std::numeric_limits<std::uint32_t>::max();
  if (bytes.size() > kLargest)
    throw InputError("it is larger than 4 GiB, which glTF does not allow; split it");
  Buffers buffers{bytes, &companions};
  tinygltf::FsCallbacks files = callbacks(buffers);
  add_size_callback(files);
  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks(files);
  reader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int,
                           const unsigned char*, int, void*) { return true; },
                        nullptr);

  tinygltf::Model model;
  std::string error;
  std::string warning;
  const auto size = static_cast<unsigned>(bytes.size());
  const auto* start = reinterpret_cast<const unsigned char*>(bytes.data());
  bool done = false;
  try {
    done = bytes.starts_with("glTF")
               ? reader.LoadBinaryFromMemory(&model, &error, &warning, start, size)
               : reader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, "");
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& thrown) {  // from the JSON library, or a list index out of range
    error = thrown.what();
  }
  require_known_extensions(model);  // before reporting an error that is only a consequence
  if (buffers.refusal) throw InputError(*buffers.refusal);
  if (!done) refuse_gltf(one_line(error));
  if (!model.asset.version.starts_with("2")) {
    throw InputError(fmt::format("it is glTF {}, but only glTF 2 is read; convert it to glTF 2.0",
                                 one_line(model.asset.version)));
  }
  if (bytes.size() + decoded_bytes(model) > kLargestMeshFile) {
    throw InputError("it and its buffers hold more than 4 GiB; split it, or reduce its triangles");
  }
  return model;
}

}  // namespace beambench::scenes::mesh
