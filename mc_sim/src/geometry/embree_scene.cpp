// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/embree_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "surf/core/error.h"
#include "surf/core/triangle_geometry.h"
#include "surf/mc/geometry/scene.h"

namespace surf::mc {

namespace {

// Faces closer than this are one interface; so the search may start that far back.
constexpr double interface_nm = 1e-3;

struct Context {
  RTCIntersectContext embree;  // first: Embree hands its address back
  const MeshView* mesh;
  Vec3 origin;
  Vec3 direction;
  EmbreeScene::Accept accept;
  void* user;
};

Vec3 area_normal(const MeshView& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3& a = mesh.vertices_nm[t[0]];
  return cross(mesh.vertices_nm[t[1]] - a, mesh.vertices_nm[t[2]] - a);
}

void filter(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  auto* context = reinterpret_cast<Context*>(args->context);
  const std::uint32_t triangle = RTCHitN_primID(args->hit, args->N, 0);
  const Vec3& corner = context->mesh->vertices_nm[context->mesh->triangles[triangle][0]];
  const Vec3 normal = area_normal(*context->mesh, triangle);
  const double along = dot(normal, context->direction);
  const double distance = dot(corner - context->origin, normal) / along;
  // A path inside the triangle's plane does not cross it; a sliver has no plane.
  if (!std::isfinite(distance) ||
      !context->accept(context->user, triangle, along / length(normal), distance))
    args->valid[0] = 0;
}

// In double, on the source triangle, with its barycentric coordinates kept inside.
EmbreeScene::Hit hit_of(const MeshView& mesh, std::uint32_t triangle, const Vec3& origin,
                        const Vec3& direction) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3& a = mesh.vertices_nm[t[0]];
  const Vec3 ab = mesh.vertices_nm[t[1]] - a;
  const Vec3 ac = mesh.vertices_nm[t[2]] - a;
  const Vec3 normal = cross(ab, ac);
  const double determinant = dot(normal, direction);
  const Vec3 q = cross(origin - a, direction);
  double u = -dot(ac, q) / determinant;
  double v = dot(ab, q) / determinant;
  u = std::clamp(u, 0.0, 1.0);
  v = std::clamp(v, 0.0, 1.0);
  if (u + v > 1.0) {
    const double excess = 0.5 * (u + v - 1.0);
    u = std::clamp(u - excess, 0.0, 1.0);
    v = 1.0 - u;
  }
  EmbreeScene::Hit hit;
  hit.triangle = triangle;
  hit.position = a + ab * u + ac * v;
  hit.normal = normal * (1.0 / std::sqrt(dot(normal, normal)));
  hit.distance = std::max(0.0, dot(hit.position - origin, direction));
  return hit;
}

}  // namespace

struct EmbreeScene::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  SceneMesh all;  // outlives the scene, which reads it
  MeshView mesh;
  Vec3 center;
  double start_back = interface_nm;
  std::atomic<std::ptrdiff_t> bytes{0};

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

EmbreeScene::EmbreeScene(TriangleMesh mesh, const Watch& watch)
    : EmbreeScene(make_scene_mesh(std::move(mesh), {}), watch) {}

EmbreeScene::EmbreeScene(SceneMesh all, const Watch& watch) : impl_(std::make_unique<Impl>()) {
  impl_->all = std::move(all);
  impl_->mesh = impl_->all.view();
  const MeshView& mesh = impl_->mesh;
  const Box box = bounds(mesh);
  impl_->center = impl_->all.center_nm;
  const Vec3 half = box.size_nm() * 0.5;
  const double largest = std::max({half.x, half.y, half.z});
  impl_->start_back =
      interface_nm + 8.0 * largest * static_cast<double>(std::numeric_limits<float>::epsilon());

  impl_->device = rtcNewDevice(nullptr);
  if (!impl_->device && rtcGetDeviceError(nullptr) != RTC_ERROR_UNSUPPORTED_CPU)
    throw Error("ray tracing", "Embree cannot start: memory, threads or address space are short",
                "Raise the limits (ulimit -v, ulimit -u), or give `job.threads=1`");
  if (!impl_->device)
    throw Unsupported("ray tracing", "Embree finds no usable device",
                      "Check that the processor has SSE2 or NEON");
  rtcSetDeviceMemoryMonitorFunction(
      impl_->device,
      [](void* user, ssize_t bytes, bool) {
        static_cast<Impl*>(user)->bytes += bytes;
        return true;
      },
      impl_.get());
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(
      impl_->scene,
      static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             impl_->all.local_nm.values.data(), 0, 3 * sizeof(float),
                             mesh.vertices_nm.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(Triangle), mesh.triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl_->scene, geometry);
  rtcReleaseGeometry(geometry);
  watch.check();
  // From any of Embree's threads: progress is not passed on.
  rtcSetSceneProgressMonitorFunction(
      impl_->scene,
      [](void* token, double) {
        const auto* const cancel = static_cast<const CancelToken*>(token);
        return !cancel || !cancel->cancelled();
      },
      const_cast<CancelToken*>(watch.cancel));
  rtcCommitScene(impl_->scene);
  watch.check();
  rtcSetSceneProgressMonitorFunction(impl_->scene, nullptr,
                                     nullptr);  // the token may go before the scene
  if (rtcGetDeviceError(impl_->device) != RTC_ERROR_NONE)
    throw InvalidInput("ray tracing", "Embree could not build the scene (out of memory?)",
                       "Simplify the mesh");
}

EmbreeScene::~EmbreeScene() = default;

double EmbreeScene::tolerance_nm() const { return impl_->start_back; }

std::size_t EmbreeScene::memory_bytes() const {
  return static_cast<std::size_t>(impl_->bytes.load()) + impl_->mesh.vertices_nm.size_bytes() +
         impl_->mesh.triangles.size_bytes() + impl_->all.local_nm.values.size_bytes();
}

bool EmbreeScene::nearest(const Vec3& origin, const Vec3& direction, double length, Accept accept,
                          void* user, Hit& hit, const Vec3& nudge) const {
  const Vec3 start = origin + nudge - direction * impl_->start_back - impl_->center;
  Context context;
  rtcInitIntersectContext(&context.embree);
  context.embree.filter = filter;
  context.mesh = &impl_->mesh;
  context.origin = origin;
  context.direction = direction;
  context.accept = accept;
  context.user = user;

  RTCRayHit ray;
  ray.ray.org_x = static_cast<float>(start.x);
  ray.ray.org_y = static_cast<float>(start.y);
  ray.ray.org_z = static_cast<float>(start.z);
  ray.ray.dir_x = static_cast<float>(direction.x);
  ray.ray.dir_y = static_cast<float>(direction.y);
  ray.ray.dir_z = static_cast<float>(direction.z);
  ray.ray.tnear = 0.0f;
  ray.ray.tfar = static_cast<float>(length + impl_->start_back);
  ray.ray.time = 0.0f;
  ray.ray.mask = 0xffffffffu;
  ray.ray.flags = 0;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context.embree, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;

  hit = hit_of(impl_->mesh, ray.hit.primID, origin, direction);
  return true;
}

bool EmbreeScene::nearest_of(std::span<const std::uint32_t> faces, const Vec3& origin,
                             const Vec3& direction, double length, Accept accept, void* user,
                             Hit& hit) const {
  const MeshView& mesh = impl_->mesh;
  double nearest = length;
  bool found = false;
  for (const std::uint32_t face : faces) {
    const Triangle& t = mesh.triangles[face];
    const Vec3 a = mesh.vertices_nm[t[0]] - origin;
    const Vec3 b = mesh.vertices_nm[t[1]] - origin;
    const Vec3 c = mesh.vertices_nm[t[2]] - origin;
    // On which side of each edge the ray passes, but for rounding: where triangles share an edge or
    // a corner, one of them at least is met, and nothing slips through.
    const double rounding = 1e-15 * (dot(a, a) + dot(b, b) + dot(c, c));
    const double u = dot(direction, cross(b, c));
    const double v = dot(direction, cross(c, a));
    const double w = dot(direction, cross(a, b));
    if (std::min({u, v, w}) < -rounding && std::max({u, v, w}) > rounding) continue;
    const Vec3 normal = cross(b - a, c - a);
    const double along = dot(normal, direction);
    const double distance = dot(a, normal) / along;
    // Not where the path lies in the triangle's plane, or the triangle has none.
    if (!std::isfinite(distance) || distance < -interface_nm || distance > nearest) continue;
    if (!accept(user, face, along / std::sqrt(dot(normal, normal)), distance)) continue;
    nearest = distance;
    hit.triangle = face;
    found = true;
  }
  if (found) hit = hit_of(mesh, hit.triangle, origin, direction);
  return found;
}

bool EmbreeScene::within(const Vec3& point, double radius, std::size_t most,
                         std::vector<std::uint32_t>& out) const {
  struct Search {
    std::vector<std::uint32_t>& out;
    std::size_t most;
  } search{out, out.size() + most};
  const Vec3 local = point - impl_->center;
  RTCPointQuery query{static_cast<float>(local.x), static_cast<float>(local.y),
                      static_cast<float>(local.z), 0.0f,
                      static_cast<float>(radius + 2 * impl_->start_back)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  const auto collect = [](RTCPointQueryFunctionArguments* args) {
    auto& s = *static_cast<Search*>(args->userPtr);
    s.out.push_back(args->primID);
    if (s.out.size() <= s.most) return false;
    args->query->radius = 0;  // enough
    return true;
  };
  rtcPointQuery(impl_->scene, &query, &context, collect, &search);
  return search.out.size() <= search.most;
}

const MeshView& EmbreeScene::mesh() const { return impl_->mesh; }

namespace {

struct FlatSearch {
  const MeshView* mesh;
  std::span<const std::uint32_t> shell_of;
  Vec3 point, normal;
  double tolerance;
  double radius;
  std::int64_t shell;  // -1: none seen yet
  int looked_at;
};

constexpr int most_looked_at = 2000;

bool look_at(RTCPointQueryFunctionArguments* args) {
  FlatSearch& search = *static_cast<FlatSearch*>(args->userPtr);
  const Triangle& t = search.mesh->triangles[args->primID];
  const Vec3& a = search.mesh->vertices_nm[t[0]];
  const Vec3& b = search.mesh->vertices_nm[t[1]];
  const Vec3& c = search.mesh->vertices_nm[t[2]];
  const double distance = length(closest_point(a, b, c, search.point) - search.point);
  if (distance >= search.radius) return false;
  const auto off = [&](const Vec3& v) {
    return std::fabs(dot(v - search.point, search.normal)) > search.tolerance;
  };
  const std::uint32_t shell = search.shell_of[args->primID];
  const bool plain = search.normal == Vec3{} || off(a) || off(b) || off(c) ||
                     (search.shell >= 0 && search.shell != shell);
  if (!plain) {
    search.shell = shell;
    // Too many to look at: what is known ends here.
    if (++search.looked_at <= most_looked_at) return false;
  }
  search.radius = distance;
  args->query->radius = static_cast<float>(distance);
  return true;
}

}  // namespace

double EmbreeScene::flat_radius(const Vec3& point, const Vec3& normal, double tolerance,
                                double most, std::span<const std::uint32_t> shell_of) const {
  // Single precision may leave out a triangle at the rim.
  const double slack = 2 * impl_->start_back;
  for (double radius = most;; radius *= 0.5) {
    FlatSearch search{&impl_->mesh, shell_of, point, normal, tolerance, radius + slack, -1, 0};
    const Vec3 local = point - impl_->center;
    RTCPointQuery query{static_cast<float>(local.x), static_cast<float>(local.y),
                        static_cast<float>(local.z), 0.0f, static_cast<float>(radius + slack)};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(impl_->scene, &query, &context, look_at, &search);
    if (search.looked_at <= most_looked_at || radius < 1)
      return std::max(0.0, std::min(search.radius - slack, most));
  }
}

double EmbreeScene::highest_along(const Vec3& direction) const {
  double highest = -HUGE_VAL;
  for (const Vec3& v : impl_->mesh.vertices_nm) highest = std::max(highest, dot(v, direction));
  return highest;
}

std::string ray_tracer_version() {
  return std::to_string(RTC_VERSION_MAJOR) + "." + std::to_string(RTC_VERSION_MINOR) + "." +
         std::to_string(RTC_VERSION_PATCH);
}

}  // namespace surf::mc
