#include "harness/rays/ray_set.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
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

/// The JSON of a pencil whose rays begin at `begin` or later, of `rays` rays in all. Throws
/// InputError without naming the file.
accel::Pencil read_pencil(const Json& json, std::uint64_t begin, std::uint64_t rays) {
  const auto whole_number = [&](const char* name) {
    const Json value = json.is_object() ? json.value(name, Json()) : Json();
    if (value.is_number_unsigned()) return value.get<std::uint64_t>();
    throw InputError(fmt::format("\"{}\" is not a whole number", name));
  };
  const std::uint64_t first = whole_number("first");
  const std::uint64_t count = whole_number("count");
  if (first < begin) throw InputError(fmt::format("it begins at ray {}, before {}", first, begin));
  if (count < 1 || first >= rays || count > rays - first) {
    throw InputError(fmt::format("{} rays from {} on are not among {} rays", count, first, rays));
  }
  const Json apex = json.value("apex", Json());
  const auto is_finite = [](const Json& coordinate) {
    return coordinate.is_number() && std::isfinite(coordinate.get<double>());
  };
  if (!apex.is_array() || apex.size() != 3 || !std::ranges::all_of(apex, is_finite)) {
    throw InputError("\"apex\" is not a list of three finite numbers");
  }
  const Json toward = json.value("toward", Json());
  if (!toward.is_boolean()) throw InputError("\"toward\" is neither true nor false");
  return {first, count, {apex[0], apex[1], apex[2]}, toward.get<bool>()};
}

std::vector<accel::Pencil> read_pencils(const std::filesystem::path& path, const Json& json,
                                        std::uint64_t rays) {
  if (!json.is_array()) fail(path, "\"pencils\" is not a list");
  std::vector<accel::Pencil> pencils;
  std::uint64_t begin = 0;
  for (const Json& each : json) {
    try {
      pencils.push_back(read_pencil(each, begin, rays));
    } catch (const InputError& error) {
      fail(path, fmt::format("pencil {}: {}", pencils.size(), error.what()));
    }
    begin = pencils.back().first + pencils.back().count;
  }
  return pencils;
}

Json json_of(const accel::Pencil& pencil) {
  return {{"first", pencil.first},
          {"count", pencil.count},
          {"apex", {pencil.apex.x, pencil.apex.y, pencil.apex.z}},
          {"toward", pencil.toward}};
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
  header.set.pencils = read_pencils(path, json.value("pencils", Json::array()), header.rays);
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
  for (const accel::Pencil& pencil : set.pencils) header["pencils"].push_back(json_of(pencil));
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
