#include "harness/rays/ray_set.hpp"

#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "harness/rays/fingerprint.hpp"
#include "scenes/core/error.hpp"
#include "scenes/core/files.hpp"

namespace beambench::rays {

double coherence(std::span<const accel::Ray> rays) {
  if (rays.size() < 2) return 1.0;
  double sum = 0.0;
  glm::dvec3 before = glm::normalize(glm::dvec3(rays.front().direction));
  for (const accel::Ray& ray : rays.subspan(1)) {
    const glm::dvec3 direction = glm::normalize(glm::dvec3(ray.direction));
    sum += glm::dot(before, direction);
    before = direction;
  }
  return sum / static_cast<double>(rays.size() - 1);
}

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFirstLine = "beambench-rays 1";
constexpr std::uint64_t kMaxRays = std::uint64_t{1} << 28U;
constexpr std::uint64_t kMaxBytes = kMaxRays * sizeof(accel::Ray) + (1U << 20U);  // and a header

static_assert(std::endian::native == std::endian::little, "rays are written as they lie in memory");
static_assert(sizeof(accel::Ray) == 8 * sizeof(float));

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& problem) {
  throw InputError(
      fmt::format("{}: {}; 'beambench rays' writes such files", path.string(), problem));
}

/// The JSON of a file.
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

Header read_header(const std::filesystem::path& path, std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) fail(path, "the second line is not a JSON object");
  Header header;
  header.set.label = path.string();
  const Json query = json.value("query", Json());
  if (query != "closest" && query != "any") fail(path, R"("query" is neither "closest" nor "any")");
  header.set.query = query == "any" ? Query::kAnyHit : Query::kClosestHit;
  const Json rays = json.value("rays", Json());
  if (!rays.is_number_unsigned() || rays.get<std::uint64_t>() < 1 ||
      rays.get<std::uint64_t>() > kMaxRays) {
    fail(path, fmt::format("\"rays\" is not a whole number from 1 to {}", kMaxRays));
  }
  header.rays = rays.get<std::uint64_t>();
  const Json seed = json.value("seed", Json(0U));
  if (!seed.is_number_unsigned()) fail(path, "\"seed\" is not a whole number");
  header.set.seed = seed.get<std::uint64_t>();
  header.set.scene_hash = read_hash(path, json, "scene_hash");
  header.hash = read_hash(path, json, "hash");
  return header;
}

/// Removes and returns the first line of a text; none when the text has no line end.
std::optional<std::string_view> take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

std::vector<accel::Ray> rays_of(const std::filesystem::path& path, std::string_view bytes,
                                std::uint64_t count) {
  // The length first: a header that promises too much must not cost the memory for it.
  if (bytes.size() != count * sizeof(accel::Ray)) {
    fail(path, fmt::format("{} bytes of rays follow the header, not the {} of {} rays",
                           bytes.size(), count * sizeof(accel::Ray), count));
  }
  std::vector<accel::Ray> rays(count);
  std::memcpy(rays.data(), bytes.data(), bytes.size());
  return rays;
}

void require_valid_rays(const std::filesystem::path& path, const std::vector<accel::Ray>& rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    try {
      accel::require_valid(rays[i]);
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
              static_cast<std::streamsize>(set.rays.size() * sizeof(accel::Ray)));
  });
}

RaySet read_ray_file(const std::filesystem::path& path) {
  const std::string text = read_input(path, kMaxBytes);
  std::string_view rest = text;
  if (take_line(rest) != kFirstLine) {
    fail(path, fmt::format("this is no file of rays: its first line is not '{}'", kFirstLine));
  }
  const std::optional<std::string_view> line = take_line(rest);
  if (!line) fail(path, "the second line is not a JSON object");
  Header header = read_header(path, *line);
  header.set.rays = rays_of(path, rest, header.rays);
  if (header.hash && *header.hash != fingerprint(header.set.rays)) {
    fail(path, "the rays are not those that were written: their hash differs from the header's");
  }
  require_valid_rays(path, header.set.rays);
  return std::move(header.set);
}

}  // namespace beambench::rays
