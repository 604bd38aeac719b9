#include "harness/rays/hit_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "accel/core/ray.hpp"
#include "harness/rays/column_names.hpp"
#include "harness/rays/csv_numbers.hpp"
#include "harness/rays/file_header.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::rays {

struct HitReader::Format {
  virtual ~Format() = default;
  virtual Query query() const = 0;
  virtual std::optional<std::uint64_t> count() const = 0;
  virtual std::size_t read(std::size_t at_most, HitTable& hits) = 0;
  virtual std::string place_of(std::size_t index) const = 0;
};

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFirstLine = "beambench-hits 1";
constexpr std::uint64_t kMaxHits = std::uint64_t{1} << 32U;
constexpr std::string_view kColumnHelp =
    "t or x,y,z, with primitive, triangle or neither; or occluded alone";

static_assert(std::endian::native == std::endian::little,
              "hits are written exactly as stored in memory");

constexpr std::string_view kRemedy = "'beambench hits' writes such files";

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& problem) {
  throw InputError(fmt::format("{}: {}; {}", path.string(), problem, kRemedy));
}

enum class Column { kT, kX, kY, kZ, kPrimitive, kTriangle, kOccluded };
constexpr std::array<std::string_view, 7> kColumnNames{"t",         "x",        "y",       "z",
                                                       "primitive", "triangle", "occluded"};
constexpr std::array<std::size_t, 7> kColumnBytes{4, 4, 4, 4, 4, 4, 1};

/// The validated columns of a file.
class Columns {
 public:
  /// `place` is where the names are in the file, for messages.
  Columns(const std::filesystem::path& path, const std::string& place,
          std::span<const std::string> names) {
    const auto places = places_of_columns(place, names, kColumnNames);
    if (!places) refuse_names(path);
    for (const std::size_t i : *places) {
      has_[i] = true;
      order_.push_back(static_cast<Column>(i));
    }
    const bool some_of_point = has(Column::kX) || has(Column::kY) || has(Column::kZ);
    for (const Column each : {Column::kX, Column::kY, Column::kZ}) {
      if (some_of_point && !has(each)) refuse_missing(place, each);
    }
    if (!some_of_point && !has(Column::kT) && !has(Column::kOccluded)) {
      refuse_missing(place, Column::kT);
    }
    const bool both_places = some_of_point && has(Column::kT);
    const bool both_ids = has(Column::kPrimitive) && has(Column::kTriangle);
    const bool both_queries = has(Column::kOccluded) && order_.size() > 1;
    if (both_places || both_ids || both_queries) {
      throw InputError(fmt::format("{}: the columns '{}' cannot be combined; expected {}", place,
                                   fmt::join(names, ","), kColumnHelp));
    }
  }

  bool has(Column column) const { return has_[static_cast<std::size_t>(column)]; }
  const std::vector<Column>& order() const { return order_; }
  Query query() const { return has(Column::kOccluded) ? Query::kAnyHit : Query::kClosestHit; }

  /// Resizes the arrays of the columns in the file to `count`, and clears the others.
  void resize(HitTable& hits, std::size_t count) const {
    hits.t.resize(has(Column::kT) ? count : 0);
    hits.points.resize(has(Column::kX) ? count : 0);
    hits.primitives.resize(has(Column::kPrimitive) ? count : 0);
    hits.triangles.resize(has(Column::kTriangle) ? count : 0);
    hits.occluded.resize(has(Column::kOccluded) ? count : 0);
  }

 private:
  [[noreturn]] static void refuse_names(const std::filesystem::path& path) {
    fail(path, fmt::format("this is not a hit file: its first line is neither '{}' nor the column "
                           "names {}",
                           kFirstLine, kColumnHelp));
  }

  [[noreturn]] static void refuse_missing(const std::string& place, Column column) {
    throw InputError(fmt::format("{}: column '{}' is missing; expected {}", place,
                                 kColumnNames[static_cast<std::size_t>(column)], kColumnHelp));
  }

  std::array<bool, 7> has_{};
  std::vector<Column> order_{};
};

void* address(HitTable& hits, Column column, std::size_t i) {
  switch (column) {
    case Column::kT:
      return &hits.t[i];
    case Column::kX:
      return &hits.points[i].x;
    case Column::kY:
      return &hits.points[i].y;
    case Column::kZ:
      return &hits.points[i].z;
    case Column::kPrimitive:
      return &hits.primitives[i];
    case Column::kTriangle:
      return &hits.triangles[i];
    case Column::kOccluded:
      break;
  }
  return &hits.occluded[i];
}

class BinaryHits : public HitReader::Format {
 public:
  BinaryHits(const std::filesystem::path& path, InputStream input)
      : path_(path), input_(std::move(input)), columns_(read_header()) {
    for (const Column column : columns_.order()) {
      record_ += kColumnBytes[static_cast<std::size_t>(column)];
    }
    begin_ = input_.position();
    if (const auto remaining = input_.remaining(); remaining && *remaining != count_ * record_) {
      refuse_length(*remaining);
    }
  }

  Query query() const override { return columns_.query(); }
  std::optional<std::uint64_t> count() const override { return count_; }
  std::string place_of(std::size_t index) const override {
    return fmt::format("{}: byte {}", path_.string(), begin_ + index * record_);
  }

  std::size_t read(std::size_t at_most, HitTable& hits) override {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(at_most, count_ - read_));
    bytes_.resize(wanted * record_);
    const std::size_t got = input_.read(bytes_);
    if (got != bytes_.size()) refuse_length(read_ * record_ + got);
    columns_.resize(hits, wanted);
    const char* next = bytes_.data();
    for (std::size_t i = 0; i < wanted; ++i) {
      for (const Column column : columns_.order()) {
        const std::size_t size = kColumnBytes[static_cast<std::size_t>(column)];
        std::memcpy(address(hits, column, i), next, size);
        next += size;
      }
    }
    read_ += wanted;
    std::array<char, 1> more{};
    if (read_ == count_ && input_.read(more) > 0) refuse_length(count_ * record_ + 1);
    return wanted;
  }

 private:
  Columns read_header() {
    const Json json = parse_file_header(path_, input_.line(), kRemedy);
    const Json hits = json.value("hits", Json());
    if (!hits.is_number_unsigned() || hits.get<std::uint64_t>() < 1 ||
        hits.get<std::uint64_t>() > kMaxHits) {
      fail(path_, fmt::format("\"hits\" is not a whole number from 1 to {}", kMaxHits));
    }
    count_ = hits.get<std::uint64_t>();
    const Json columns = json.value("columns", Json());
    const auto is_text = [](const Json& each) { return each.is_string(); };
    if (!columns.is_array() || !std::ranges::all_of(columns, is_text)) {
      fail(path_, R"("columns" is not a list of names, such as ["t", "primitive"])");
    }
    return {path_, path_.string() + ":2", columns.get<std::vector<std::string>>()};
  }

  [[noreturn]] void refuse_length(std::uint64_t bytes) const {
    fail(path_, fmt::format("{} bytes of hits follow the header; expected {} for {} hits", bytes,
                            count_ * record_, count_));
  }

  std::filesystem::path path_;
  InputStream input_;
  std::uint64_t count_ = 0;
  Columns columns_;
  std::size_t record_ = 0;   ///< bytes of a hit
  std::uint64_t begin_ = 0;  ///< offset of the hits, in bytes
  std::uint64_t read_ = 0;
  std::vector<char> bytes_{};
};

constexpr double kNone = scenes::kNoPrimitive;

class CsvHits : public HitReader::Format {
 public:
  CsvHits(const std::filesystem::path& path, InputStream input, std::string_view first_line)
      : path_(path),
        numbers_(path, std::move(input), first_line),
        columns_(path, fmt::format("{}:1", path.string()), numbers_.columns()),
        row_(columns_.order().size()) {
    for (const Column column : columns_.order()) when_empty_.push_back(missing(column));
  }

  Query query() const override { return columns_.query(); }
  std::optional<std::uint64_t> count() const override { return std::nullopt; }
  std::string place_of(std::size_t index) const override { return numbers_.place_of(index); }

  std::size_t read(std::size_t at_most, HitTable& hits) override {
    columns_.resize(hits, at_most);
    std::size_t used = 0;
    for (; used < at_most && numbers_.next(row_, when_empty_); ++used) {
      for (std::size_t i = 0; i < row_.size(); ++i) {
        store(hits, columns_.order()[i], used, row_[i]);
      }
      ++read_;
    }
    if (read_ == 0) fail(path_, "it contains no hits");
    columns_.resize(hits, used);
    return used;
  }

 private:
  static double missing(Column column) {
    switch (column) {
      case Column::kPrimitive:
      case Column::kTriangle:
        return kNone;
      case Column::kOccluded:
        return std::numeric_limits<double>::quiet_NaN();
      default:
        return accel::kInfinity;
    }
  }

  void store(HitTable& hits, Column column, std::size_t i, double value) const {
    void* const place = address(hits, column, i);
    switch (column) {
      case Column::kPrimitive:
      case Column::kTriangle: {
        const std::uint32_t id = value == -1.0 ? scenes::kNoPrimitive : whole(value, column, kNone);
        std::memcpy(place, &id, sizeof id);
        return;
      }
      case Column::kOccluded:
        hits.occluded[i] = static_cast<std::uint8_t>(whole(value, column, 1.0));
        return;
      default: {
        const auto rounded = static_cast<float>(value);
        std::memcpy(place, &rounded, sizeof rounded);
        return;
      }
    }
  }

  std::uint32_t whole(double value, Column column, double largest) const {
    if (value >= 0.0 && value <= largest && value == std::floor(value)) {
      return static_cast<std::uint32_t>(value);
    }
    throw InputError(fmt::format(
        "{}: column '{}' holds {}, which is not a whole number from 0 to {}",
        numbers_.place_of(read_), kColumnNames[static_cast<std::size_t>(column)], value, largest));
  }

  std::filesystem::path path_;
  CsvNumbers numbers_;
  Columns columns_;
  std::vector<double> row_;
  std::vector<double> when_empty_{};
  std::size_t read_ = 0;
};

std::unique_ptr<HitReader::Format> open_hits(const std::filesystem::path& path) {
  InputStream input(path);
  const std::string first(input.line().value_or(""));
  if (first == kFirstLine) return std::make_unique<BinaryHits>(path, std::move(input));
  return std::make_unique<CsvHits>(path, std::move(input), first);
}

void write_binary(std::ostream& out, const TraceResults& results, const Json& note) {
  const auto* any = std::get_if<AnyHits>(&results);
  const auto* hits = std::get_if<accel::HitBuffer>(&results);
  const Json header{
      {"hits", any != nullptr ? any->size() : hits->size()},
      {"columns", any != nullptr ? Json::array({"occluded"}) : Json::array({"t", "primitive"})},
      {"note", note}};
  out << kFirstLine << '\n' << json_text(header, -1) << '\n';
  if (any != nullptr) {
    out.write(reinterpret_cast<const char*>(any->data()),
              static_cast<std::streamsize>(any->size()));
    return;
  }
  for (std::size_t i = 0; i < hits->size(); ++i) {
    std::array<char, 8> record{};
    std::memcpy(record.data(), hits->t() + i, 4);
    std::memcpy(record.data() + 4, hits->primitive() + i, 4);
    out.write(record.data(), record.size());
  }
}

void write_csv(std::ostream& out, const TraceResults& results) {
  if (const auto* any = std::get_if<AnyHits>(&results)) {
    out << "occluded\n";
    for (const std::uint8_t each : *any) out << (each == 0 ? "0\n" : "1\n");
    return;
  }
  out << "t,primitive\n";
  const auto& hits = std::get<accel::HitBuffer>(results);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto hit = hits.get(i);
    out << (hit ? fmt::format("{},{}\n", hit->t, hit->primitive) : "inf,-1\n");
  }
}

}  // namespace

void write_hit_file(const std::filesystem::path& path, const TraceResults& results,
                    const nlohmann::ordered_json& note) {
  write_file(path, [&](std::ostream& out) {
    if (path.extension() == kCsvEnding) {
      write_csv(out, results);
    } else {
      write_binary(out, results, note);
    }
  });
}

HitReader::HitReader(const std::filesystem::path& path) : format_(open_hits(path)) {}
HitReader::~HitReader() = default;
HitReader::HitReader(HitReader&&) noexcept = default;

Query HitReader::query() const { return format_->query(); }
std::optional<std::uint64_t> HitReader::count() const { return format_->count(); }
std::size_t HitReader::read(std::size_t at_most, HitTable& hits) {
  return format_->read(at_most, hits);
}
std::string HitReader::place_of(std::size_t index) const {
  return printable(format_->place_of(index));
}

}  // namespace beambench::rays
