// In the compiled form, a user's backscatter law needs sonar/side_scan/record.hpp.
// expect: a law other than the built-in ones needs .*sonar/side_scan/record.hpp
#define INSONIFY_COMPILED
#include <insonify/insonify.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#ifndef INSONIFY_COMPILE_FAIL
#include <insonify/sonar/side_scan/record.hpp>
#endif

namespace in = insonify;

struct even {
    float operator()(float) const { return 1; }
};

in::frame<> record(const in::scene& scene) {
    return in::render(scene, in::side_scan{}, in::record_options<>{}.with(even{}));
}
