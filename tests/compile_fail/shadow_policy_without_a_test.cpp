// The object that a shadow policy builds needs a test().
// expect: a shadow policy has build.*which returns an object with
#include <insonify/insonify.hpp>
#include <insonify/sonar/overhead/render.hpp>

namespace in = insonify;

struct all_lit {
    all_lit build(std::span<const in::shadow::caster>, const auto&, const auto&, auto&) const { return {}; }
#ifndef INSONIFY_COMPILE_FAIL
    void test(const in::shadow::points& at, const in::shadow::results& into) const {
        for (std::size_t i = 0; i < at.size(); ++i) into.lit[i] = 1, into.caster[i] = in::shadow::invalid_id;
    }
#endif
};

in::frame<> draw(const in::scene& scene) {
    return in::render<all_lit>(scene, {});
}
