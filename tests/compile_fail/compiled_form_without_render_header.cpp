// In the compiled form, a user's backscatter law needs sonar/overhead/render.hpp.
// expect: a shadow policy, law or depth other than the built-in ones needs .*sonar/overhead/render.hpp
#define INSONIFY_COMPILED
#include <insonify/insonify.hpp>
#ifndef INSONIFY_COMPILE_FAIL
#include <insonify/sonar/overhead/render.hpp>
#endif

namespace in = insonify;

struct isotropic {
    float operator()(float) const { return 1; }
};

in::frame<> draw(const in::scene& scene) {
    return in::render(scene, in::overhead{}, in::render_options<>{}.with(isotropic{}));
}
