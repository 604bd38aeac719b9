#include "harness/rays/ray_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/rays/column_names.hpp"
#include "harness/rays/csv_numbers.hpp"
#include "harness/rays/file_header.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::rays {

struct RayReader::Format {
  virtual ~Format() = default;
  virtual std::optional<std::uint64_t> count() const = 0;
  virtual std::size_t read(std::span<accel::Ray> rays) = 0;
  virtual double part() const = 0;

  RaySet header{};
};

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFirstLine = "beambench-rays 1";
constexpr std::uint64_t kMaxRaysInFile = std::uint64_t{1} << 32U;
constexpr std::uint64_t kMaxRaysInMemory = std::uint64_t{1} << 28U;

static_assert(std::endian::native == std::endian::little,
              "rays are written exactly as stored in memory");
static_assert(sizeof(accel::Ray) == 8 * sizeof(float));

constexpr std::string_view kRemedy = "'beambench rays' writes such files";

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& problem) {
  throw InputError(fmt::format("{}: {}; {}", path.string(), problem, kRemedy));
}

double part_of(const InputStream& input) {
  const auto remaining = input.remaining();
  if (!remaining) return 0.0;
  const auto done = static_cast<double>(input.position());
  return done / std::max(done + static_cast<double>(*remaining), 1.0);
}

void require_valid_ray(const accel::Ray& ray, const std::function<std::string()>& place) {
  try {
    accel::require_valid(ray);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place(), error.what()));
  }
}

// Binary files

/// Parses a pencil whose first ray is `begin` or later, in a list of `rays` rays. Throws InputError
/// without the file name.
accel::Pencil read_pencil(const Json& json, std::uint64_t begin, std::uint64_t rays) {
  const auto whole_number = [&](const char* name) {
    const Json value = json.is_object() ? json.value(name, Json()) : Json();
    if (value.is_number_unsigned()) return value.get<std::uint64_t>();
    throw InputError(fmt::format("\"{}\" is not a whole number", name));
  };
  const std::uint64_t first = whole_number("first");
  const std::uint64_t count = whole_number("count");
  if (first < begin)
    throw InputError(fmt::format("it begins at ray {}; expected {} or later", first, begin));
  if (count < 1 || first >= rays || count > rays - first) {
    throw InputError(
        fmt::format("{} rays starting at ray {} do not fit in {} rays", count, first, rays));
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

class BinaryRays : public RayReader::Format {
 public:
  BinaryRays(const std::filesystem::path& path, InputStream input)
      : path_(path), input_(std::move(input)) {
    read_header(parse_file_header(path, input_.line(), kRemedy));
    begin_ = input_.position();
    const std::uint64_t bytes = count_ * sizeof(accel::Ray);
    if (const auto remaining = input_.remaining(); remaining && *remaining != bytes) {
      refuse_length(*remaining);
    }
  }

  std::optional<std::uint64_t> count() const override { return count_; }
  double part() const override { return static_cast<double>(read_) / static_cast<double>(count_); }

  std::size_t read(std::span<accel::Ray> rays) override {
    const std::size_t wanted =
        static_cast<std::size_t>(std::min<std::uint64_t>(rays.size(), count_ - read_));
    rays = rays.first(wanted);
    const std::size_t bytes =
        input_.read({reinterpret_cast<char*>(rays.data()), rays.size_bytes()});
    if (bytes != rays.size_bytes()) refuse_length(read_ * sizeof(accel::Ray) + bytes);
    fingerprint_.add(rays);
    if (read_ + wanted == count_) require_end();
    for (const accel::Ray& ray : rays) {
      require_valid_ray(ray, [&] {
        return fmt::format("{}: ray {} (byte {})", path_.string(), read_,
                           begin_ + read_ * sizeof(accel::Ray));
      });
      ++read_;
    }
    return wanted;
  }

 private:
  void read_header(const Json& json) {
    header.label = name_of_path(path_.string());
    const Json query = json.value("query", Json());
    if (query != "closest" && query != "any") {
      fail(path_, R"("query" is neither "closest" nor "any")");
    }
    header.query = query == "any" ? Query::kAnyHit : Query::kClosestHit;
    const Json rays = json.value("rays", Json());
    if (!rays.is_number_unsigned() || rays.get<std::uint64_t>() < 1 ||
        rays.get<std::uint64_t>() > kMaxRaysInFile) {
      fail(path_, fmt::format("\"rays\" is not a whole number from 1 to {}", kMaxRaysInFile));
    }
    count_ = rays.get<std::uint64_t>();
    header.pencils = read_pencils(path_, json.value("pencils", Json::array()), count_);
    const Json seed = json.value("seed", Json(0U));
    if (!seed.is_number_unsigned()) fail(path_, "\"seed\" is not a whole number");
    header.seed = seed.get<std::uint64_t>();
    header.may_graze = read_flag(json, "may_graze");
    header.must_hit = read_flag(json, "must_hit");
    header.scene_hash = read_hash(path_, json, "scene_hash");
    hash_ = read_hash(path_, json, "hash");
  }

  bool read_flag(const Json& json, const char* name) const {
    const Json flag = json.value(name, Json(false));
    if (!flag.is_boolean()) fail(path_, fmt::format("\"{}\" is neither true nor false", name));
    return flag.get<bool>();
  }

  [[noreturn]] void refuse_length(std::uint64_t bytes) const {
    fail(path_, fmt::format("{} bytes of rays follow the header; expected {} for {} rays", bytes,
                            count_ * sizeof(accel::Ray), count_));
  }

  void require_end() {
    std::array<char, 1> more{};
    if (input_.read(more) > 0) refuse_length(count_ * sizeof(accel::Ray) + 1);
    if (hash_ && *hash_ != fingerprint_.value()) {
      fail(path_,
           "the rays have changed since they were written: their hash differs from the header's");
    }
  }

  std::filesystem::path path_;
  InputStream input_;
  std::uint64_t begin_ = 0;  ///< offset of the rays, in bytes
  std::uint64_t count_ = 0;
  std::uint64_t read_ = 0;
  std::optional<std::uint64_t> hash_{};
  RayFingerprint fingerprint_{};
};

// CSV

constexpr std::array<std::string_view, 8> kColumns{"ox", "oy", "oz", "t_min",
                                                   "dx", "dy", "dz", "t_max"};
constexpr double kRequired = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, 8> kWhenEmpty{kRequired, kRequired, kRequired, 0.0,
                                           kRequired, kRequired, kRequired, accel::kInfinity};

class CsvRays : public RayReader::Format {
 public:
  CsvRays(const std::filesystem::path& path, InputStream input, std::string_view first_line)
      : path_(path), numbers_(path, std::move(input), first_line) {
    header.label = name_of_path(path.string());
    const std::string place = fmt::format("{}:1", path.string());
    const auto places = places_of_columns(place, numbers_.columns(), kColumns);
    if (!places) refuse_columns();
    places_ = *places;
    for (const std::size_t i : places_) when_empty_.push_back(kWhenEmpty[i]);
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      if (!std::isnan(kWhenEmpty[i]) || std::ranges::find(places_, i) != places_.end()) continue;
      throw InputError(fmt::format("{}: column '{}' is missing; only t_min and t_max are optional",
                                   place, kColumns[i]));
    }
    row_.resize(places_.size());
  }

  std::optional<std::uint64_t> count() const override { return std::nullopt; }
  double part() const override { return part_of(numbers_.input()); }

  std::size_t read(std::span<accel::Ray> rays) override {
    std::size_t used = 0;
    for (; used < rays.size() && numbers_.next(row_, when_empty_); ++used, ++read_) {
      std::array<float, 8> values{};
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(kWhenEmpty[i]);
      for (std::size_t i = 0; i < row_.size(); ++i) {
        values[places_[i]] = static_cast<float>(row_[i]);
      }
      rays[used] = std::bit_cast<accel::Ray>(values);
      require_valid_ray(rays[used], [&] { return numbers_.place_of(read_); });
    }
    if (read_ == 0) fail(path_, "it contains no rays");
    return used;
  }

 private:
  [[noreturn]] void refuse_columns() const {
    fail(path_, fmt::format("this is not a ray file: its first line is neither '{}' nor the column "
                            "names ox,oy,oz,t_min,dx,dy,dz,t_max",
                            kFirstLine));
  }

  std::filesystem::path path_;
  CsvNumbers numbers_;
  std::vector<std::size_t> places_{};  ///< within a ray, by column
  std::vector<double> when_empty_{};
  std::vector<double> row_{};
  std::size_t read_ = 0;
};

std::unique_ptr<RayReader::Format> open_rays(const std::filesystem::path& path) {
  InputStream input(path);
  const std::string first(input.line().value_or(""));
  if (first == kFirstLine) return std::make_unique<BinaryRays>(path, std::move(input));
  return std::make_unique<CsvRays>(path, std::move(input), first);
}

void write_binary(std::ostream& out, const RaySet& set, const Json& note) {
  Json header{{"query", to_string(set.query)},
              {"rays", set.rays.size()},
              {"seed", set.seed},
              {"hash", hex_digits(fingerprint(set.rays))}};
  if (set.scene_hash) header["scene_hash"] = hex_digits(*set.scene_hash);
  for (const accel::Pencil& pencil : set.pencils) header["pencils"].push_back(json_of(pencil));
  if (set.may_graze) header["may_graze"] = true;
  if (set.must_hit) header["must_hit"] = true;
  header["note"] = note;
  out << kFirstLine << '\n' << json_text(header, -1) << '\n';
  out.write(reinterpret_cast<const char*>(set.rays.data()),
            static_cast<std::streamsize>(set.rays.size() * sizeof(accel::Ray)));
}

void write_csv(std::ostream& out, const RaySet& set) {
  out << fmt::format("{}\n", fmt::join(kColumns, ","));
  for (const accel::Ray& ray : set.rays) {
    const auto floats = std::bit_cast<std::array<float, 8>>(ray);
    std::array<double, 8> numbers{};  // a double's shortest text, not a float's
    std::ranges::copy(floats, numbers.begin());
    out << fmt::format("{}\n", fmt::join(numbers, ","));
  }
}

}  // namespace

void write_ray_file(const std::filesystem::path& path, const RaySet& set,
                    const nlohmann::ordered_json& note) {
  write_file(path, [&](std::ostream& out) {
    if (path.extension() == kCsvEnding) {
      write_csv(out, set);
    } else {
      write_binary(out, set, note);
    }
  });
}

RayReader::RayReader(const std::filesystem::path& path) : format_(open_rays(path)) {}
RayReader::~RayReader() = default;
RayReader::RayReader(RayReader&&) noexcept = default;

const RaySet& RayReader::header() const { return format_->header; }
std::optional<std::uint64_t> RayReader::count() const { return format_->count(); }
std::size_t RayReader::read(std::span<accel::Ray> rays) { return format_->read(rays); }
double RayReader::part() const { return format_->part(); }

RaySet read_ray_file(const std::filesystem::path& path) {
  constexpr std::size_t kBlock = std::size_t{1} << 16U;
  RayReader reader(path);
  RaySet set = reader.header();
  if (reader.count().value_or(0) > kMaxRaysInMemory) {
    fail(path, fmt::format("it contains {} rays; at most {} can be read at once", *reader.count(),
                           kMaxRaysInMemory));
  }
  // A pipe may deliver fewer rays than its header states.
  std::error_code has_no_length;
  const std::uint64_t bytes = std::filesystem::file_size(path, has_no_length);
  if (!has_no_length) {
    set.rays.reserve(static_cast<std::size_t>(
        std::min<std::uint64_t>(reader.count().value_or(0), bytes / sizeof(accel::Ray))));
  }
  for (std::size_t count = kBlock; count == kBlock;) {
    const std::size_t used = set.rays.size();
    if (used > kMaxRaysInMemory) {
      fail(path, fmt::format("it contains more than {} rays, the most that can be read at once",
                             kMaxRaysInMemory));
    }
    set.rays.resize(used + kBlock);
    count = reader.read(std::span(set.rays).subspan(used));
    set.rays.resize(used + count);
  }
  return set;
}

}  // namespace beambench::rays
