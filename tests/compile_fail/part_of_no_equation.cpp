// A part of the sonar equation without any of its functions.
// expect: a part of the sonar equation has one of over_direction
#include <insonify/sonar/side_scan/sonar_equation.hpp>

namespace in = insonify;

struct own_noise {
    double noise() const { return 1e-6; }
};
struct misnamed_noise {
    double noise_level() const { return 1e-6; }
};

double noise_of_equation() {
#if defined(INSONIFY_COMPILE_FAIL)
    return in::sonar_equation{misnamed_noise{}, in::level_gain{}}.noise();
#else
    return in::sonar_equation{own_noise{}, in::level_gain{}}.noise();
#endif
}
