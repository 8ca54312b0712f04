// A part of the sonar equation without any of its functions.
// expect: a part of the sonar equation has one of over_direction
#include <insonify/sonar/side_scan/sonar_equation.hpp>

namespace in = insonify;

struct steady_noise {
#if defined(INSONIFY_COMPILE_FAIL)
    double noise_level() const {
        return 1e-6;
    }
#else
    double noise() const {
        return 1e-6;
    }
#endif
};

double noise_of_equation() {
    return in::sonar_equation{steady_noise{}, in::level_gain{}}.noise();
}
