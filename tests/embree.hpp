// Rays and packets of 16 rays by Embree 4, or by Embree 3 where only that is installed.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace embree {

#if RTC_VERSION_MAJOR >= 4

/// Without this flag, a scene ignores the filters of queries.
constexpr RTCSceneFlags filtered_by_queries = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

/// How rays are traced. A filter, which may reject hits, finds the query as the `context` of its arguments.
class query : public RTCRayQueryContext {
  public:
    explicit query(bool coherent, RTCFilterFunctionN filter = nullptr) {
        rtcInitRayQueryContext(this);
        rtcInitIntersectArguments(&closest_);
        rtcInitOccludedArguments(&any_);
        closest_.context = any_.context = this;
        closest_.filter = any_.filter = filter;
        unsigned flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
        if (filter != nullptr) flags |= RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
        closest_.flags = any_.flags = static_cast<RTCRayQueryFlags>(flags);
    }
    query(const query&) = delete;
    query& operator=(const query&) = delete;

    void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &closest_); }
    void occlude(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, &any_); }
    void intersect(RTCScene scene, const int* wanted, RTCRayHit16& rays) {
        rtcIntersect16(wanted, scene, &rays, &closest_);
    }
    void occlude(RTCScene scene, const int* wanted, RTCRay16& rays) { rtcOccluded16(wanted, scene, &rays, &any_); }

  private:
    RTCIntersectArguments closest_;
    RTCOccludedArguments any_;
};

#else

constexpr RTCSceneFlags filtered_by_queries = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

class query : public RTCIntersectContext {
  public:
    explicit query(bool coherent, RTCFilterFunctionN rejects = nullptr) {
        rtcInitIntersectContext(this);
        flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        filter = rejects;
    }
    query(const query&) = delete;
    query& operator=(const query&) = delete;

    void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, this, &ray); }
    void occlude(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, this, &ray); }
    void intersect(RTCScene scene, const int* wanted, RTCRayHit16& rays) { rtcIntersect16(wanted, scene, this, &rays); }
    void occlude(RTCScene scene, const int* wanted, RTCRay16& rays) { rtcOccluded16(wanted, scene, this, &rays); }
};

#endif

}  // namespace embree
