// Recordings need a header of their own.
// expect: a recording needs .*sonar/side_scan/recording.hpp
#include <insonify/insonify.hpp>
#ifndef INSONIFY_COMPILE_FAIL
#include <insonify/sonar/side_scan/recording.hpp>
#endif

namespace in = insonify;

void record(const in::scene& scene) {
    (void)in::render(scene, in::side_scan{});
}
