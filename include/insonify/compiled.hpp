// The compiled form: pictures and seabeds are compiled once, in a unit of its own, instead of in every unit that draws.
//
//     #define INSONIFY_IMPLEMENTATION     // in one source file of the program, compiled with -O2
//     #include <insonify/insonify.hpp>
//
//     #define INSONIFY_COMPILED           // in all others, or -DINSONIFY_COMPILED; CMake: link insonify::compiled
//     #include <insonify/insonify.hpp>
//
// This list is what one defines and the others leave to it. Other shadow policies, laws and seabeds work too: include
// the header that draws with them (sonar/overhead/render.hpp), and the unit compiles what the list lacks.
#pragma once

#include <insonify/config.hpp>

#if defined(INSONIFY_COMPILED)

#include <insonify/seabed/flat.hpp>
#include <insonify/seabed/mud.hpp>
#include <insonify/seabed/ripples.hpp>
#include <insonify/seabed/rock.hpp>
#include <insonify/sonar/overhead/picture.hpp>

#if defined(INSONIFY_IMPLEMENTATION)
#include <insonify/sonar/overhead/render.hpp>
#define INSONIFY_ONCE template
#else
#define INSONIFY_ONCE extern template
#endif

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail {

#define INSONIFY_PAINT(Shadow, Labels)                                                                      \
    INSONIFY_ONCE frame<Labels> paint(const scene&, const overhead&, const render_options<Shadow, Labels>&, \
                                      executor_ref);
INSONIFY_PAINT(shadow::none, labels)
INSONIFY_PAINT(shadow::none, no_labels)
INSONIFY_PAINT(shadow::exact, labels)
INSONIFY_PAINT(shadow::exact, no_labels)
#undef INSONIFY_PAINT
INSONIFY_ONCE visibility see(const scene&, const overhead&, const render_options<shadow::none, labels>&, executor_ref);

}  // namespace detail

namespace seabed {

#define INSONIFY_SEABED(Model)               \
    INSONIFY_ONCE struct any::holder<Model>; \
    INSONIFY_ONCE struct any_sampler::prepared<Model>;
INSONIFY_SEABED(flat)
INSONIFY_SEABED(mud)
INSONIFY_SEABED(ripples)
INSONIFY_SEABED(rock)
#undef INSONIFY_SEABED

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

#undef INSONIFY_ONCE
#endif
