// A plug-in with the fault named by the environment variable FAULT; none if it is empty.

#include <csignal>
#include <cstdlib>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <beambench/plugin.hpp>

namespace {

using namespace beambench;
using namespace beambench::accel;
using namespace beambench::plugin;
using namespace beambench::scenes;

bool fault_is(std::string_view name) {
  const char* fault = std::getenv("FAULT");
  return fault != nullptr && name == fault;
}

void crash() { std::raise(SIGSEGV); }  // as a wild pointer would

void hang() {
  for (volatile bool forever = true; forever;) {
  }
}

constexpr std::size_t kMany = 1;  // primitives

/// Faults that occur before any function of the plug-in is called.
struct AtLoad {
  AtLoad() {
    if (fault_is("crash at load")) crash();
    if (fault_is("exit at load")) std::exit(0);
    if (fault_is("throw at load")) throw std::runtime_error("not today");
  }
} at_load;

/// Tests every primitive, so its results are correct unless FAULT names a fault.
class Faulty : public TraversalAccelerator<Faulty> {
 public:
  explicit Faulty(const Scene& scene) : scene_(&scene) {
    if (fault_is("throw in build")) throw std::runtime_error("no memory of that");
    if (fault_is("throw a number in build")) throw 42;
    if (fault_is("crash in build")) crash();
  }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    if (fault_is("throw in trace")) throw std::runtime_error("lost the way");
    if (fault_is("crash in trace")) crash();
    if (fault_is("abort in trace")) std::abort();
    if (fault_is("exit in trace")) std::exit(0);
    if (fault_is("hang in trace")) hang();
    if (fault_is("hang over empty") && scene_->primitives.empty()) hang();
    if (scene_->primitives.size() > kMany) {
      if (fault_is("crash in trace of many")) crash();
      if (fault_is("abort in trace of many")) std::abort();
      if (fault_is("exit in trace of many")) std::exit(0);
      if (fault_is("hang in trace of many")) hang();
    }
    if (fault_is("primitive out of range")) return Hit{1.0F, 4'000'000'000U};
    if (fault_is("t is not a number")) return Hit{std::numeric_limits<float>::quiet_NaN(), 0};
    if (fault_is("answers nothing")) return std::nullopt;
    ClosestHit closest(ray);
    for (PrimitiveId id = 0; id < scene_->primitives.size(); ++id) closest.test(*scene_, id);
    counting.add(Counter::kPrimitiveTests, scene_->primitives.size());
    return closest.result();
  }
  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    return find_closest(ray, counting).has_value() != fault_is("any hit is the other way round");
  }
  std::vector<BeamPlace> places(const RaySource& rays) const override {
    if (fault_is("places of too few rays")) return std::vector<BeamPlace>(rays.size() - 1);
    if (fault_is("a side of no cube")) return {rays.size(), BeamPlace{.side = 6}};
    return {};
  }
  Statistics statistics() const override {
    if (fault_is("throw in statistics")) throw std::runtime_error("never counted");
    return {};
  }

 private:
  const Scene* scene_;
};

std::unique_ptr<Accelerator> build(const Scene& scene, const Parameters& parameters,
                                   const Workload&) {
  if (fault_is("nothing built")) return nullptr;
  if (!fault_is("parameter ignored")) parameters.integer("leaf");
  if (fault_is("refuses spheres") && !scene.spheres.empty()) throw InputError("no spheres here");
  return std::make_unique<Faulty>(scene);
}

Scene generate(const Parameters& parameters) {
  if (fault_is("throw in scene")) throw std::runtime_error("no idea");
  if (fault_is("crash in scene")) crash();
  SceneBuilder builder("named otherwise");
  for (std::int64_t i = 0; i < parameters.integer("n"); ++i) {
    builder.add_sphere({2.0 * static_cast<double>(i), 0.0, 0.0}, 1.0);
  }
  Scene scene = std::move(builder).build();
  if (fault_is("scene beyond its arrays")) scene.primitives.front().index = 1000;
  return scene;
}

Scene read(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  if (fault_is("reader refuses")) throw InputError(file.string() + ":1: it holds no spheres");
  warnings.push_back(file.string() + ":2: a word was skipped");
  SceneBuilder builder("read");
  builder.add_sphere({0.0, 0.0, 0.0}, 1.0);
  return std::move(builder).build();
}

void fill(PluginContents& contents) {
  if (fault_is("throw in fill")) throw std::runtime_error("not ready");
  if (fault_is("hang in fill")) hang();
  if (fault_is("brings nothing")) return;
  const std::string name = fault_is("taken name") ? "samet"
                           : fault_is("no name")  ? "my structure:1"
                           : fault_is("reserved") ? "all"
                                                  : "faulty";
  const std::int64_t leaf = fault_is("default out of range") ? 0 : 4;
  contents.structures.push_back({name,
                                 fault_is("no summary") ? "" : "tests every primitive",
                                 Conformance::kBitExact,
                                 {integer_parameter("leaf", 4, 1, 8, "not used")},
                                 build});
  if (leaf == 0) contents.structures.back().parameters.front().default_value = "0";
  if (fault_is("name given twice")) contents.structures.push_back(contents.structures.front());
  if (fault_is("no function")) contents.structures.front().build = nullptr;
  contents.scenes.push_back({fault_is("taken scene") ? "balls" : "row",
                             "spheres in a row",
                             {integer_parameter("n", 3, 1, 100, "spheres")},
                             generate});
  contents.readers.push_back(
      {fault_is("taken ending") ? ".obj" : ".row", "one sphere, whatever the file says", read});
}

}  // namespace

const Plugin beambench_plugin{.description = "Faults to order", .fill = fill};
