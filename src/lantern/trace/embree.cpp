// SPDX-License-Identifier: MIT
#include "lantern/trace/embree.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "lantern/core/error.h"
#include "lantern/scene/surface.h"

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

namespace lantern {
namespace {

static_assert(sizeof(RayPacket) == sizeof(RTCRay16) && alignof(RayPacket) >= alignof(RTCRay16));
static_assert(offsetof(RayPacket, near) == offsetof(RTCRay16, tnear));
static_assert(offsetof(RayPacket, direction_x) == offsetof(RTCRay16, dir_x));
static_assert(offsetof(RayPacket, far) == offsetof(RTCRay16, tfar));
static_assert(offsetof(RayPacket, flags) == offsetof(RTCRay16, flags));

/// What Embree 3 calls a context and Embree 4 arguments, for rays that are neighbours or not.
class Query {
 public:
#if RTC_VERSION_MAJOR >= 4
  explicit Query(bool coherent) {
    const auto flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    intersect_.flags = occluded_.flags = flags;
  }
  void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &intersect_); }
  void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, &occluded_); }
  void intersect(const int* valid, RTCScene scene, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &rays, &intersect_);
  }
  void occluded(const int* valid, RTCScene scene, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &rays, &occluded_);
  }

 private:
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
#else
  explicit Query(bool coherent) {
    rtcInitIntersectContext(&context_);
    context_.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
  void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context_, &ray); }
  void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &context_, &ray); }
  void intersect(const int* valid, RTCScene scene, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &context_, &rays);
  }
  void occluded(const int* valid, RTCScene scene, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &context_, &rays);
  }

 private:
  RTCIntersectContext context_;
#endif
};

RTCRay to_embree(const Ray& ray) {
  RTCRay out{};
  out.org_x = ray.origin.x;
  out.org_y = ray.origin.y;
  out.org_z = ray.origin.z;
  out.dir_x = ray.direction.x;
  out.dir_y = ray.direction.y;
  out.dir_z = ray.direction.z;
  out.tnear = ray.near;
  out.tfar = ray.far;
  out.mask = ~0u;
  return out;
}

class EmbreeTracer final : public Tracer {
 public:
  EmbreeTracer(const Scene& scene, const World& world)
      : content_(scene), world_(world), device_(rtcNewDevice(nullptr)) {
    if (!device_) throw Error("Embree could not be started");
    rtcSetDeviceErrorFunction(device_, &EmbreeTracer::note_error, this);
    tree_ = rtcNewScene(device_);
    // Robust: no ray slips between two triangles that share an edge.
    rtcSetSceneFlags(tree_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(tree_, RTC_BUILD_QUALITY_HIGH);

    std::vector<std::uint32_t> solid, masked;
    for (std::uint32_t t = 0; t < world.size(); ++t) {
      const bool may_have_holes = has_holes(scene.materials[index(world.materials[t])]);
      (may_have_holes ? masked : solid).push_back(t);
    }
    vertices_ = rtcNewBuffer(device_, world.positions.size() * sizeof(Vec3));
    if (void* data = vertices_ ? rtcGetBufferData(vertices_) : nullptr) {
      std::memcpy(data, world.positions.data(), world.positions.size() * sizeof(Vec3));
    }
    attach(std::move(solid), false);
    attach(std::move(masked), true);
    rtcCommitScene(tree_);
    if (!error_.empty()) {
      release();
      throw Error("Embree could not build its tree: " + error_);
    }
  }
  ~EmbreeTracer() override { release(); }
  EmbreeTracer(const EmbreeTracer&) = delete;
  EmbreeTracer& operator=(const EmbreeTracer&) = delete;

  Hit closest(const Ray& ray) const override {
    RTCRayHit query{};
    query.ray = to_embree(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    Query(false).intersect(tree_, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {query.ray.tfar, triangle(query.hit.geomID, query.hit.primID),
            Vec2(query.hit.u, query.hit.v)};
  }

  bool occluded(const Ray& ray) const override {
    RTCRay query = to_embree(ray);
    Query(false).occluded(tree_, query);
    return query.tfar < 0.0f;
  }

  void occluded(const LaneMask& active, RayPacket& packet) const override {
    Query(true).occluded(active.lane, tree_, reinterpret_cast<RTCRay16&>(packet));
  }

  void closest(const LaneMask& active, RayPacket& packet, Hit* hits) const override {
    RTCRayHit16 query;
    std::memcpy(&query.ray, &packet, sizeof(RayPacket));
    for (int i = 0; i < kPacket; ++i) {
      query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      hits[i] = {};
    }
    Query(true).intersect(active.lane, tree_, query);
    for (int i = 0; i < kPacket; ++i) {
      if (active.lane[i] == 0 || query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      hits[i] = {query.ray.tfar[i], triangle(query.hit.geomID[i], query.hit.primID[i]),
                 Vec2(query.hit.u[i], query.hit.v[i])};
    }
  }

 private:
  /// Adds these triangles of the world as one geometry; `holes` asks the alpha mask at each hit.
  void attach(std::vector<std::uint32_t> triangles, bool holes) {
    if (triangles.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices_, 0,
                         sizeof(Vec3), world_.positions.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(uvec3), triangles.size());
    if (indices) {
      for (std::size_t i = 0; i < triangles.size(); ++i) {
        static_cast<uvec3*>(indices)[i] = world_.triangles[triangles[i]];
      }
      if (holes) {
        rtcSetGeometryUserData(geometry, this);
        rtcSetGeometryIntersectFilterFunction(geometry, &EmbreeTracer::pass_holes);
        rtcSetGeometryOccludedFilterFunction(geometry, &EmbreeTracer::pass_holes);
      }
      rtcCommitGeometry(geometry);
      const unsigned id = rtcAttachGeometry(tree_, geometry);
      if (triangles_.size() <= id) triangles_.resize(id + 1);
      triangles_[id] = std::move(triangles);
    }
    rtcReleaseGeometry(geometry);
  }

  static void pass_holes(const RTCFilterFunctionNArguments* args) {
    const auto& self = *static_cast<const EmbreeTracer*>(args->geometryUserPtr);
    for (unsigned i = 0; i < args->N; ++i) {
      if (args->valid[i] == 0) continue;
      const unsigned geometry = RTCHitN_geomID(args->hit, args->N, i);
      const unsigned primitive = RTCHitN_primID(args->hit, args->N, i);
      const Vec2 uv(RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i));
      const Vec3 origin(RTCRayN_org_x(args->ray, args->N, i), RTCRayN_org_y(args->ray, args->N, i),
                        RTCRayN_org_z(args->ray, args->N, i));
      const Vec3 direction(RTCRayN_dir_x(args->ray, args->N, i),
                           RTCRayN_dir_y(args->ray, args->N, i),
                           RTCRayN_dir_z(args->ray, args->N, i));
      if (is_hole(self.content_, self.world_, self.triangle(geometry, primitive), uv, origin,
                  direction)) {
        args->valid[i] = 0;
      }
    }
  }

  static void note_error(void* self, RTCError, const char* text) {
    static_cast<EmbreeTracer*>(self)->error_ = text ? text : "unknown error";
  }

  std::uint32_t triangle(unsigned geometry, unsigned primitive) const {
    return triangles_[geometry][primitive];
  }

  void release() {
    if (tree_) rtcReleaseScene(tree_);
    if (vertices_) rtcReleaseBuffer(vertices_);
    if (device_) rtcReleaseDevice(device_);
    tree_ = nullptr;
    vertices_ = nullptr;
    device_ = nullptr;
  }

  const Scene& content_;
  const World& world_;
  RTCDevice device_ = nullptr;
  RTCScene tree_ = nullptr;
  RTCBuffer vertices_ = nullptr;  // of all geometries
  std::vector<std::vector<std::uint32_t>>
      triangles_;  // geometry, primitive -> triangle of the world
  std::string error_;
};

}  // namespace

std::unique_ptr<Tracer> make_embree_tracer(const Scene& scene, const World& world) {
  return std::make_unique<EmbreeTracer>(scene, world);
}

}  // namespace lantern
