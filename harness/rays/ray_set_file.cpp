#include "harness/rays/ray_set_file.hpp"

#include <bit>
#include <charconv>
#include <fstream>

#include <fmt/format.h>

#include "harness/files/pending_file.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/error.hpp"

namespace beambench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFirstLine = "beambench-rays 1";
constexpr std::uint64_t kMostRays = std::uint64_t{1} << 28U;

static_assert(std::endian::native == std::endian::little, "rays are written as they lie in memory");
static_assert(sizeof(Ray) == 8 * sizeof(float));

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& problem) {
  throw InputError(
      fmt::format("{}: {}; 'beambench rays' writes such files", path.string(), problem));
}

/// What the JSON of a file says.
struct Header {
  RaySet set;
  std::uint64_t rays = 0;
  std::optional<std::uint64_t> hash;
};

std::optional<std::uint64_t> read_hash(const std::filesystem::path& path, const Json& json,
                                       const char* name) {
  if (!json.contains(name)) return std::nullopt;
  const std::string text = json[name].is_string() ? json[name].get<std::string>() : "";
  std::uint64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (text.size() != 16 || error != std::errc() || stop != text.data() + text.size()) {
    fail(path, fmt::format("\"{}\" is not a string of sixteen hexadecimal digits", name));
  }
  return value;
}

Header read_header(const std::filesystem::path& path, const std::string& line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) fail(path, "the second line is not a JSON object");
  Header header;
  header.set.label = path.string();
  const Json query = json.value("query", Json());
  if (query != "closest" && query != "any") fail(path, R"("query" is neither "closest" nor "any")");
  header.set.query = query == "any" ? Query::kAnyHit : Query::kClosestHit;
  const Json rays = json.value("rays", Json());
  if (!rays.is_number_unsigned() || rays.get<std::uint64_t>() < 1 ||
      rays.get<std::uint64_t>() > kMostRays) {
    fail(path, fmt::format("\"rays\" is not a whole number from 1 to {}", kMostRays));
  }
  header.rays = rays.get<std::uint64_t>();
  const Json seed = json.value("seed", Json(0U));
  if (!seed.is_number_unsigned()) fail(path, "\"seed\" is not a whole number");
  header.set.seed = seed.get<std::uint64_t>();
  header.set.scene_hash = read_hash(path, json, "scene_hash");
  header.hash = read_hash(path, json, "hash");
  return header;
}

std::vector<Ray> read_rays(const std::filesystem::path& path, std::istream& file,
                           std::uint64_t count) {
  // The length first: a header that promises too much must not cost the memory for it.
  const auto begin = file.tellg();
  file.seekg(0, std::ios::end);
  const auto bytes = static_cast<std::uint64_t>(file.tellg() - begin);
  file.seekg(begin);
  if (bytes != count * sizeof(Ray)) {
    fail(path, fmt::format("{} bytes of rays follow the header, not the {} of {} rays", bytes,
                           count * sizeof(Ray), count));
  }
  std::vector<Ray> rays(count);
  file.read(reinterpret_cast<char*>(rays.data()), static_cast<std::streamsize>(bytes));
  if (!file) fail(path, "the rays cannot be read");
  return rays;
}

void require_valid_rays(const std::filesystem::path& path, const std::vector<Ray>& rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    try {
      require_valid(rays[i]);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: ray {}: {}", path.string(), i, error.what()));
    }
  }
}

}  // namespace

void write_ray_file(const std::filesystem::path& path, const RaySet& set,
                    const nlohmann::ordered_json& note) {
  Json header{{"query", to_string(set.query)},
              {"rays", set.rays.size()},
              {"seed", set.seed},
              {"hash", hex_digits(fingerprint(set.rays))}};
  if (set.scene_hash) header["scene_hash"] = hex_digits(*set.scene_hash);
  header["note"] = note;
  write_file(path, [&](std::ostream& out) {
    out << kFirstLine << '\n' << header.dump() << '\n';
    out.write(reinterpret_cast<const char*>(set.rays.data()),
              static_cast<std::streamsize>(set.rays.size() * sizeof(Ray)));
  });
}

RaySet read_ray_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (!file || !std::filesystem::is_regular_file(path)) {
    throw InputError(fmt::format("cannot open the ray file '{}'; check its name", path.string()));
  }
  if (!std::getline(file, line) || line != kFirstLine) {
    fail(path, fmt::format("this is no file of rays: its first line is not '{}'", kFirstLine));
  }
  if (!std::getline(file, line)) fail(path, "the second line is not a JSON object");
  Header header = read_header(path, line);
  header.set.rays = read_rays(path, file, header.rays);
  if (header.hash && *header.hash != fingerprint(header.set.rays)) {
    fail(path, "the rays are not those that were written: their hash differs from the header's");
  }
  require_valid_rays(path, header.set.rays);
  return std::move(header.set);
}

}  // namespace beambench
