// Traces the rays of a .rays file with CGAL's AABB tree and writes the hits for
// `beambench verify --hits`. Usage: cgal_hits scene.obj r.rays -o cgal.hits [--kernel epick]
//
// README.md, in the parent folder, explains the treatment of t_min and t_max.

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/version.h>

namespace {

constexpr auto kUsage =
    "usage: cgal_hits MESH RAYS -o HITS [--kernel cartesian|epick]\n\n"
    "Traces the rays of a .rays file with CGAL's AABB tree over an OBJ file that `beambench "
    "export`\n"
    "wrote, and writes a .hits file for `beambench verify --hits`. Prints one line of JSON.\n\n"
    "  --kernel cartesian  Simple_cartesian<double> (default)\n"
    "  --kernel epick      Exact_predicates_inexact_constructions_kernel\n\n"
    "Exit codes: 0 success, 2 invalid arguments or input.\n";
constexpr std::uint32_t kNoTriangle = 0xFFFFFFFF;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kRaysOfAPart = 1 << 16;

// The layout in the files, in the little-endian order of this machine.
struct RayOfFile {
  float origin[3], t_min, direction[3], t_max;
};
struct HitOfFile {
  float point[3]{kInfinity, kInfinity, kInfinity};
  std::uint32_t triangle = kNoTriangle;
};
static_assert(sizeof(RayOfFile) == 32 && sizeof(HitOfFile) == 16);

template <class Kernel>
std::vector<typename Kernel::Triangle_3> read_triangles(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::vector<typename Kernel::Point_3> points;
  std::vector<typename Kernel::Triangle_3> triangles;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line.size() < 2 ? "" : line.substr(2));
    if (line.starts_with("v ")) {
      // The scene's coordinates are floats; the file has enough digits for them.
      float x, y, z;
      if (!(words >> x >> y >> z)) throw std::runtime_error(path + ": not a vertex: " + line);
      points.emplace_back(x, y, z);
    } else if (line.starts_with("f ")) {
      std::size_t a, b, c;
      if (!(words >> a >> b >> c)) throw std::runtime_error(path + ": not a triangle: " + line);
      triangles.emplace_back(points.at(a - 1), points.at(b - 1), points.at(c - 1));
    }
  }
  if (triangles.empty()) throw std::runtime_error(path + " has no triangles");
  return triangles;
}

/// Returns the value after `"name":` in a line of JSON written by beambench.
std::string member(const std::string& json, const std::string& name) {
  const std::string key = '"' + name + "\":";
  const std::size_t at = json.find(key);
  if (at == std::string::npos) throw std::runtime_error("the header of the rays lacks " + key);
  return json.substr(at + key.size());
}

template <class Kernel>
class Tracer {
 public:
  explicit Tracer(const std::string& mesh)
      : triangles_(read_triangles<Kernel>(mesh)), tree_(triangles_.begin(), triangles_.end()) {
    tree_.build();
  }

  std::size_t triangles() const { return triangles_.size(); }

  HitOfFile closest(const RayOfFile& ray) const {
    HitOfFile hit;
    // CGAL's rays have no end. The hit is compared with t_max afterwards; no hit is lost, because
    // the closest hit is beyond t_max only if all hits are.
    const auto found = tree_.first_intersection(typename Kernel::Ray_3(start(ray), vector(ray)));
    if (!found) return hit;
    const Point* point = boost::get<Point>(&found->first);
    // A ray in the triangle's plane meets it in a segment, whose ends are not ordered.
    const auto* segment = boost::get<typename Kernel::Segment_3>(&found->first);
    const Point nearest = point != nullptr ? *point
                          : t_of(ray, segment->source()) < t_of(ray, segment->target())
                              ? segment->source()
                              : segment->target();
    if (t_of(ray, nearest) > ray.t_max) return hit;
    for (int i = 0; i < 3; ++i) hit.point[i] = static_cast<float>(nearest[i]);
    hit.triangle = static_cast<std::uint32_t>(found->second - triangles_.begin());
    return hit;
  }

  std::uint8_t any(const RayOfFile& ray) const {
    if (std::isinf(ray.t_max)) {
      return tree_.do_intersect(typename Kernel::Ray_3(start(ray), vector(ray))) ? 1 : 0;
    }
    return tree_.do_intersect(typename Kernel::Segment_3(start(ray), at(ray, ray.t_max))) ? 1 : 0;
  }

 private:
  using Point = typename Kernel::Point_3;
  using Vector = typename Kernel::Vector_3;
  using Triangles = std::vector<typename Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, typename Triangles::const_iterator>;

  static Vector vector(const RayOfFile& ray) {
    return {ray.direction[0], ray.direction[1], ray.direction[2]};
  }
  static Point at(const RayOfFile& ray, double t) {
    return Point(ray.origin[0], ray.origin[1], ray.origin[2]) + t * vector(ray);
  }
  static Point start(const RayOfFile& ray) { return at(ray, ray.t_min); }
  static double t_of(const RayOfFile& ray, const Point& point) {
    return CGAL::to_double((point - at(ray, 0)) * vector(ray) / vector(ray).squared_length());
  }

  Triangles triangles_;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree_;
};

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <class Kernel>
void trace(const std::string& mesh, const std::string& rays, const std::string& hits,
           const std::string& kernel) {
  std::ifstream in(rays, std::ios::binary);
  std::string magic, header;
  std::getline(in, magic);
  std::getline(in, header);
  if (magic != "beambench-rays 1") throw std::runtime_error(rays + " is not a ray file");
  const std::size_t count = std::stoull(member(header, "rays"));
  const bool any = member(header, "query").starts_with("\"any\"");

  const auto begin = std::chrono::steady_clock::now();
  const Tracer<Kernel> tracer(mesh);
  const double build_seconds = seconds_since(begin);

  const std::string partial = hits + ".partial";  // the file at `hits` is always complete
  std::ofstream out(partial, std::ios::binary);
  out << "beambench-hits 1\n{\"hits\": " << count
      << ", \"columns\": " << (any ? R"(["occluded"])" : R"(["x", "y", "z", "triangle"])") << "}\n";
  double seconds = 0;
  std::vector<RayOfFile> part;
  for (std::size_t done = 0; done < count; done += part.size()) {
    part.resize(std::min(kRaysOfAPart, count - done));
    const auto bytes = static_cast<std::streamsize>(part.size() * sizeof(RayOfFile));
    if (!in.read(reinterpret_cast<char*>(part.data()), bytes)) {
      throw std::runtime_error(rays + " is too short");
    }
    std::fprintf(stderr, "%zu of %zu rays\n", done, count);
    const auto part_begin = std::chrono::steady_clock::now();
    std::vector<HitOfFile> closest(any ? 0 : part.size());
    std::vector<std::uint8_t> occluded(any ? part.size() : 0);
    for (std::size_t i = 0; i < closest.size(); ++i) closest[i] = tracer.closest(part[i]);
    for (std::size_t i = 0; i < occluded.size(); ++i) occluded[i] = tracer.any(part[i]);
    seconds += seconds_since(part_begin);
    out.write(reinterpret_cast<const char*>(closest.data()),
              static_cast<std::streamsize>(closest.size() * sizeof(HitOfFile)));
    out.write(reinterpret_cast<const char*>(occluded.data()),
              static_cast<std::streamsize>(occluded.size()));
  }
  out.close();
  if (!out || std::rename(partial.c_str(), hits.c_str()) != 0) {
    throw std::runtime_error("cannot write " + hits);
  }
  std::printf(R"({"version": "CGAL %s %s", "triangles": %zu, "rays": %zu, "build_seconds": %.3f, )"
              R"("trace_seconds": %.3f})"
              "\n",
              CGAL_VERSION_STR, kernel.c_str(), tracer.triangles(), count, build_seconds, seconds);
}

}  // namespace

int main(int argc, char** argv) try {
  std::vector<std::string> files;
  std::string hits, kernel = "cartesian";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--help" || word == "-h") return std::fputs(kUsage, stdout) < 0 ? 2 : 0;
    if (word != "-o" && word != "--kernel") {
      files.push_back(word);
    } else if (i + 1 < argc) {
      (word == "-o" ? hits : kernel) = argv[++i];
    }
  }
  if (files.size() != 2 || hits.empty()) throw std::runtime_error("wrong arguments; see --help");
  if (kernel == "cartesian") {
    trace<CGAL::Simple_cartesian<double>>(files[0], files[1], hits, kernel);
  } else if (kernel == "epick") {
    trace<CGAL::Exact_predicates_inexact_constructions_kernel>(files[0], files[1], hits, kernel);
  } else {
    throw std::runtime_error("no kernel '" + kernel + "'; see --help");
  }
  return 0;
} catch (const std::exception& problem) {
  std::fprintf(stderr, "error: %s\n", problem.what());
  return 2;
}
