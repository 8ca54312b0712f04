// The compiled form: pictures, recordings, seabeds and filters are compiled in one unit instead of in every unit that
// uses them.
//
//     #define INSONIFY_IMPLEMENTATION     // in one source file of the program, compiled with -O2
//     #include <insonify/insonify.hpp>
//
//     #define INSONIFY_COMPILED           // in all others, or -DINSONIFY_COMPILED; CMake: link insonify::compiled
//     #include <insonify/insonify.hpp>
//
// The lists below name what is compiled once. To use other shadow policies, laws and seabeds, include the header that
// draws with them (sonar/overhead/render.hpp): a unit compiles for itself whatever the lists do not name.
#pragma once

#include <insonify/config.hpp>

#if defined(INSONIFY_COMPILED)

#include <insonify/filter/colormap.hpp>
#include <insonify/filter/echo_noise.hpp>
#include <insonify/filter/histogram.hpp>
#include <insonify/filter/match.hpp>
#include <insonify/filter/noise.hpp>
#include <insonify/filter/pipe.hpp>
#include <insonify/seabed/flat.hpp>
#include <insonify/seabed/mud.hpp>
#include <insonify/seabed/ripples.hpp>
#include <insonify/seabed/rock.hpp>
#include <insonify/sonar/display.hpp>
#include <insonify/sonar/overhead/picture.hpp>

#if defined(INSONIFY_IMPLEMENTATION)
#include <insonify/sonar/overhead/render.hpp>
#include <insonify/sonar/side_scan/record.hpp>
#include <insonify/sonar/speckle.hpp>
#endif

namespace insonify {
inline namespace INSONIFY_ABI {

namespace seabed::inline INSONIFY_ONCE {

#define INSONIFY_SEABEDS(each) each(flat) each(mud) each(ripples) each(rock)
#define INSONIFY_SEABED(Model) std::shared_ptr<const detail::model_interface> hold(Model m);
INSONIFY_SEABEDS(INSONIFY_SEABED)
#undef INSONIFY_SEABED

}  // namespace seabed::inline INSONIFY_ONCE

namespace detail {

using matched_speckle = filter_chain<match_histogram, speckle>;
using matched_gaussian = filter_chain<match_histogram, gaussian>;
using equalized_speckle = filter_chain<equalize, speckle>;
using displayed_looks = filter_chain<gamma_speckle, display>;

}  // namespace detail

inline namespace INSONIFY_ONCE {

// Filters of what `render` draws. Others are compiled where they are used.
#define INSONIFY_FILTERS(each)                                                                                      \
    each(float, equalize) each(float, match_histogram) each(float, match_binned) each(float, gaussian)              \
        each(float, speckle) each(float, salt_and_pepper) each(float, detail::matched_speckle)                      \
            each(float, detail::matched_gaussian) each(float, detail::equalized_speckle) each(float, gamma_speckle) \
                each(float, display) each(float, detail::displayed_looks) each(rgb8, color_table)
#define INSONIFY_FILTER(Result, Filter)                               \
    image<Result> operator|(const image<float>& in, const Filter& f); \
    image<Result> operator|(image<float>&& in, const Filter& f);
INSONIFY_FILTERS(INSONIFY_FILTER)
#undef INSONIFY_FILTER

}  // namespace INSONIFY_ONCE

#if defined(INSONIFY_IMPLEMENTATION)

inline namespace INSONIFY_ONCE {

#define INSONIFY_FILTER(Result, Filter)                                \
    image<Result> operator|(const image<float>& in, const Filter& f) { \
        return apply(in, f);                                           \
    }                                                                  \
    image<Result> operator|(image<float>&& in, const Filter& f) {      \
        return apply(std::move(in), f);                                \
    }
INSONIFY_FILTERS(INSONIFY_FILTER)
#undef INSONIFY_FILTER

}  // namespace INSONIFY_ONCE

namespace seabed::inline INSONIFY_ONCE {

#define INSONIFY_SEABED(Model)                                     \
    std::shared_ptr<const detail::model_interface> hold(Model m) { \
        return seabed::hold<Model>(m);                             \
    }
INSONIFY_SEABEDS(INSONIFY_SEABED)
#undef INSONIFY_SEABED

}  // namespace seabed::inline INSONIFY_ONCE

namespace detail::inline INSONIFY_ONCE {

#define INSONIFY_PICTURE(Shadow, Labels)                                                              \
    frame<Labels> render_frame(const scene& s, const overhead& rig, built_in<Shadow, Labels> options, \
                               executor_ref ex) {                                                     \
        return detail::render_frame<>(s, rig, options, ex);                                           \
    }
INSONIFY_PICTURES(INSONIFY_PICTURE)
#undef INSONIFY_PICTURE
visibility render_visibility(const scene& s, const overhead& rig, built_in<shadow::none, labels> options,
                             executor_ref ex) {
    return detail::render_visibility<>(s, rig, options, ex);
}

#define INSONIFY_RECORDING(Labels, Law)                                                               \
    frame<Labels> record_pings(const scene& s, std::span<const ping> track, const range_bins& window, \
                               const erased_options<Labels, Law>& options, executor_ref ex) {         \
        return detail::record_pings<>(s, track, window, options, ex);                                 \
    }
INSONIFY_RECORDINGS(INSONIFY_RECORDING)
#undef INSONIFY_RECORDING

}  // namespace detail::inline INSONIFY_ONCE

#endif
#undef INSONIFY_FILTERS
#undef INSONIFY_SEABEDS
#undef INSONIFY_PICTURES
#undef INSONIFY_RECORDINGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

#endif
