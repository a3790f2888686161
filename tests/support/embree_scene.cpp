#include "tests/support/embree_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <numeric>
#include <thread>

namespace helio::test {
namespace {

RTCRay rayOf(const Ray& ray) {
    RTCRay r;
    r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
    r.tnear = 0, r.tfar = ray.limit, r.time = 0;
    r.mask = ~0u, r.id = 0, r.flags = 0;
    return r;
}

}  // namespace

EmbreeScene::EmbreeScene(std::span<const glm::vec3> corners, unsigned threads, bool robust)
    : threads_(threads) {
    device_ = rtcNewDevice(fmt::format("threads={}", threads).c_str());
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* total, ssize_t bytes, bool) {
            *static_cast<std::size_t*>(total) += std::size_t(bytes);
            return true;
        },
        &bytes_);
    scene_ = rtcNewScene(device_);
    if (robust) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(glm::vec3), corners.size());
    std::memcpy(vertices, corners.data(), corners.size_bytes());
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), corners.size() / 3));
    std::iota(indices, indices + corners.size(), 0u);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    const auto start = std::chrono::steady_clock::now();
    rtcCommitScene(scene_);
    buildSeconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

void EmbreeScene::run(std::span<const Ray> rays, RayQuestion question, std::span<RayHit> hits) const {
    constexpr std::size_t chunk = 4096;
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t first = next.fetch_add(chunk); first < rays.size(); first = next.fetch_add(chunk)) {
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            for (std::size_t i = first; i < std::min(first + chunk, rays.size()); ++i) {
                if (question == RayQuestion::Any) {
                    RTCRay ray = rayOf(rays[i]);
                    rtcOccluded1(scene_, &context, &ray);
                    hits[i] = {rays[i].limit, ray.tfar < 0 ? 0 : -1};
                } else {
                    RTCRayHit query;
                    query.ray = rayOf(rays[i]);
                    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
                    rtcIntersect1(scene_, &context, &query);
                    const bool hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
                    hits[i] = {query.ray.tfar, hit ? std::int32_t(query.hit.primID) : -1};
                }
            }
        }
    };
    std::vector<std::thread> helpers;
    for (unsigned k = 1; k < threads_; ++k) helpers.emplace_back(work);
    work();
    for (std::thread& helper : helpers) helper.join();
}

}  // namespace helio::test
