#include "accel/oracle/oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "accel/core/canonical_ray.hpp"
#include "accel/embree_api/device.hpp"
#include "accel/oracle/exact_tests.hpp"

namespace beambench::accel::oracle {

namespace {

using embree::to_embree;
using embree::to_embree_query;

/// The state of a query in Embree. It keeps the best hit's t as a double, because Embree's own ray
/// has only a float.
struct OracleQuery : embree::Context {
  explicit OracleQuery(const Ray& r)
      : Context(false),
        ray(r),
        exponent(std::ilogb(r.direction[static_cast<int>(longest_axis(r.direction))])) {}

  ExactRay ray;
  int exponent;             ///< exponent of the direction's longest component
  double best = kInfinity;  ///< t of the best hit
  scenes::PrimitiveId primitive = scenes::kNoPrimitive;
};

OracleQuery& query_of(embree::RawContext* context) { return *static_cast<OracleQuery*>(context); }

/// Returns a float that is not below t. Embree prunes by this value, so errors must be on the far
/// side.
float at_least(double t) {
  constexpr float kSmallest = std::numeric_limits<float>::min();
  return std::nextafter(std::max(static_cast<float>(t), kSmallest), kInfinity);
}

/// Returns the ray for Embree, whose traversal misses boxes if the direction's components are tiny.
/// The direction is scaled by a power of two, which is exact, so that its longest component is in
/// [1, 2). The interval is rounded outward.
RTCRay scaled(const OracleQuery& query) {
  Ray ray = query.ray.floats;
  for (int axis = 0; axis < 3; ++axis) {
    ray.direction[axis] = std::ldexp(ray.direction[axis], -query.exponent);
  }
  constexpr float kLargest = std::numeric_limits<float>::max();
  const auto enter = static_cast<float>(std::ldexp(double{ray.t_min}, query.exponent));
  const bool is_from_origin = enter <= 2.0F * std::numeric_limits<float>::min();
  ray.t_min = is_from_origin ? 0.0F : std::nextafter(std::min(enter, kLargest), 0.0F);
  ray.t_max = at_least(std::ldexp(double{ray.t_max}, query.exponent));
  return to_embree(ray);
}

/// A user geometry holds all primitives of one kind; it defines their number and, for each, its
/// owner, its bounds and the first hit of a ray.
struct Triangles {
  const scenes::Scene& scene;

  std::size_t count() const { return scene.triangles.size(); }
  scenes::PrimitiveId owner(std::size_t i) const { return scene.triangles[i].primitive; }
  ExactBounds bounds(std::size_t i) const { return bounds_of(scene, scene.triangles[i]); }
  std::optional<double> hit(const ExactRay& ray, std::size_t i) const {
    return first_hit(ray, scene, scene.triangles[i]);
  }
};

template <class Shape>
struct Shapes {
  const std::vector<Shape>& shapes;
  std::vector<scenes::PrimitiveId> owners;

  Shapes(const scenes::Scene& scene, scenes::PrimitiveKind kind, const std::vector<Shape>& all)
      : shapes(all), owners(all.size()) {
    for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
      const scenes::Primitive& primitive = scene.primitives[id];
      if (primitive.kind == kind) owners[primitive.index] = id;
    }
  }
  std::size_t count() const { return shapes.size(); }
  scenes::PrimitiveId owner(std::size_t i) const { return owners[i]; }
  ExactBounds bounds(std::size_t i) const { return bounds_of(shapes[i]); }
  std::optional<double> hit(const ExactRay& ray, std::size_t i) const {
    return first_hit(ray, shapes[i]);
  }
};

/// A kind of primitives and the padding of their bounds, passed to Embree as user data.
template <class Kind>
struct Padded {
  Kind kind;
  double pad;

  static const Padded& of(const void* user_data) { return *static_cast<const Padded*>(user_data); }

  static void on_bounds(const RTCBoundsFunctionArguments* arguments) {
    const Padded& self = of(arguments->geometryUserPtr);
    const ExactBounds bounds = self.kind.bounds(arguments->primID);
    const glm::vec3 lower(bounds.lower - self.pad);  // rounding is far smaller than the padding
    const glm::vec3 upper(bounds.upper + self.pad);
    *arguments->bounds_o = {lower.x, lower.y, lower.z, 0.0F, upper.x, upper.y, upper.z, 0.0F};
  }

  // The oracle traces only single rays, so N is 1 in both callbacks. For Embree 4, `valid` must
  // state whether there was a hit.
  static void on_intersect(const RTCIntersectFunctionNArguments* arguments) {
    if (arguments->valid[0] == 0) return;
    const Padded& self = of(arguments->geometryUserPtr);
    OracleQuery& query = query_of(arguments->context);
    const std::optional<double> t = self.kind.hit(query.ray, arguments->primID);
    const scenes::PrimitiveId owner = self.kind.owner(arguments->primID);
    if (!t || *t > query.best || (*t == query.best && owner >= query.primitive)) {
      arguments->valid[0] = 0;
      return;
    }
    query.best = *t;
    query.primitive = owner;
    RTCRayHitN* const ray_hit = arguments->rayhit;
    RTCRayN_tfar(RTCRayHitN_RayN(ray_hit, 1), 1, 0) = at_least(std::ldexp(*t, query.exponent));
    RTCHitN_geomID(RTCRayHitN_HitN(ray_hit, 1), 1, 0) = arguments->geomID;
    RTCHitN_primID(RTCRayHitN_HitN(ray_hit, 1), 1, 0) = arguments->primID;
  }

  static void on_occluded(const RTCOccludedFunctionNArguments* arguments) {
    if (arguments->valid[0] == 0) return;
    const Padded& self = of(arguments->geometryUserPtr);
    if (self.kind.hit(query_of(arguments->context).ray, arguments->primID)) {
      RTCRayN_tfar(arguments->ray, 1, 0) = -kInfinity;
    } else {
      arguments->valid[0] = 0;
    }
  }

  void attach(RTCDevice device, RTCScene scene) {
    if (kind.count() == 0) return;
    const embree::GeometryHandle geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(kind.count()));
    rtcSetGeometryUserData(geometry.get(), this);
    rtcSetGeometryBoundsFunction(geometry.get(), on_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), on_intersect);
    rtcSetGeometryOccludedFunction(geometry.get(), on_occluded);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene, geometry.get());
  }
};

double padding(const scenes::Scene& scene, double reach) {
  return 4.0 * 0x1p-23 * (static_cast<double>(scene.bounds.largest_coordinate()) + reach);
}

}  // namespace

struct Oracle::State {
  State(const scenes::Scene& s, double pad)
      : device(""),
        triangles{{s}, pad},
        spheres{{s, scenes::PrimitiveKind::kSphere, s.spheres}, pad},
        cones{{s, scenes::PrimitiveKind::kCone, s.cones}, pad},
        scene(rtcNewScene(device.get())) {
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    triangles.attach(device.get(), scene.get());
    spheres.attach(device.get(), scene.get());
    cones.attach(device.get(), scene.get());
    rtcCommitScene(scene.get());
    device.check("building the oracle over " + s.name);
  }

  embree::Device device;
  Padded<Triangles> triangles;
  Padded<Shapes<scenes::Sphere>> spheres;
  Padded<Shapes<scenes::Cone>> cones;
  embree::SceneHandle scene;
};

Oracle::Oracle(const scenes::Scene& scene, double reach)
    : state_(std::make_unique<State>(scene, padding(scene, reach))) {}
Oracle::~Oracle() = default;

std::optional<ExactHit> Oracle::closest_hit(const Ray& ray) const {
  OracleQuery query(ray);
  RTCRayHit ray_hit = to_embree_query(ray);
  ray_hit.ray = scaled(query);
  embree::intersect(state_->scene.get(), query, ray_hit);
  if (query.primitive == scenes::kNoPrimitive) return std::nullopt;
  return ExactHit{query.best, query.primitive};
}

bool Oracle::any_hit(const Ray& ray) const {
  OracleQuery query(ray);
  RTCRay out = scaled(query);
  return embree::occluded(state_->scene.get(), query, out);
}

}  // namespace beambench::accel::oracle
