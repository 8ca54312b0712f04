// Runs the stages of a filter chain: fuses adjacent point-wise stages into one pass over the image, and starts a new
// pass at each measured stage, which reads the finished image.
#pragma once

#include <insonify/filter/detail/run_pass.hpp>

#include <type_traits>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A stage that is itself a pixel function. It outlives the pass.
template <class F>
struct pass_by_reference {
    const F* stage;
    template <class Pixel>
        requires(pixel_function<const F, Pixel>)
    INSONIFY_INLINE auto operator()(const Pixel& pixel, int x, int y) const { return call_pixel(*stage, pixel, x, y); }
    template <class From, class To>
        requires(row_function<const F, From>)
    void row(const From* from, To* to, int count, int x, int y) const { stage->row(from, to, count, x, y); }
};

/// The identity: the pass before the first stage.
struct identity_pass {
    template <class Pixel>
    INSONIFY_INLINE Pixel operator()(const Pixel& pixel, int, int) const {
        return pixel;
    }
};

/// Two passes fused into one.
template <class First, class Second>
struct fused {
    First first;
    Second second;

    template <class Pixel>
    INSONIFY_INLINE auto operator()(const Pixel& pixel, int x, int y) {
        return call_pixel(second, call_pixel(first, pixel, x, y), x, y);
    }
    template <class From, class To>
    INSONIFY_INLINE void row(const From* from, To* to, int count, int x, int y) {
        using between = pass_result<First, From>;
        if constexpr (!row_function<First, From> && !row_function<Second, between>) {
            for (int i = 0; i < count; ++i) to[i] = (*this)(from[i], x + i, y);
        } else if constexpr (std::is_same_v<between, To>) {
            call_row(first, from, to, count, x, y);
            call_row(second, to, to, count, x, y);
        } else {
            between buffer[run_length];
            call_row(first, from, buffer, count, x, y);
            call_row(second, buffer, to, count, x, y);
        }
    }
    int rows_above() const { return (std::max)(detail::rows_above(first), detail::rows_above(second)); }
    void prepare(const pixel_area& area) {
        prepare_pass(first, area);
        prepare_pass(second, area);
    }
};

template <class Pixel, class F, executor E>
auto make_pass(const F& stage, [[maybe_unused]] image_view<const Pixel> seen, [[maybe_unused]] E& ex) {
    if constexpr (measured_filter<F, Pixel>)
        if constexpr (requires { stage.pass(seen, ex); })
            return stage.pass(seen, ex);
        else
            return stage.pass(seen);
    else if constexpr (requires { stage.pass(); })
        return stage.pass();
    else
        return pass_by_reference<F>{&stage};
}

template <class F, class Pixel>
struct filter_result {
    using type =
        pass_result<decltype(make_pass<Pixel>(std::declval<const F&>(), {}, std::declval<const serial_executor&>())),
                    Pixel>;
};
template <class F, class Pixel>
    requires image_filter<F, Pixel>
struct filter_result<F, Pixel> {
    using type =
        typename std::remove_cvref_t<decltype(std::declval<const F&>()(std::declval<image<Pixel>>()))>::value_type;
};

/// Whether each stage accepts the result of the one before.
template <class Pixel>
constexpr bool chain_takes() {
    return true;
}
template <class Pixel, class F, class... Rest>
constexpr bool chain_takes() {
    if constexpr (filter_for<F, Pixel>)
        return chain_takes<typename filter_result<F, Pixel>::type, Rest...>();
    else
        return false;
}

/// Results go to a new image, or in place where the source is an rvalue of the same pixel type.
struct into_image {};

/// Results go to the caller's view.
template <class To>
struct into_view {
    image_view<To> target;
};

/// Arguments that all stages share.
template <class E, class Sink>
struct run_context {
    E& ex;
    pixel_origin origin;
    Sink sink;
};

/// Runs a pass and returns its image: in place where the source is an rvalue of the same pixel type.
template <class Source, class Pass, executor E>
auto materialize(Source&& source, const Pass& pass, E& ex, pixel_origin origin) {
    using from = typename std::remove_cvref_t<Source>::value_type;
    using to = pass_result<Pass, from>;
    constexpr bool owned = std::is_same_v<Source, image<from>>;
    if constexpr (std::is_same_v<Pass, identity_pass>) {
        return image<from>(std::forward<Source>(source));
    } else if constexpr (owned && std::is_same_v<from, to>) {
        run_pass<from>(source, source.view(), pass, ex, origin);
        return std::move(source);
    } else {
        image<to> out(source.width(), source.height(), uninitialized{}, memory_of(ex));
        run_pass<from>(source, out.view(), pass, ex, origin);
        return out;
    }
}

/// Runs the stages on `source` after `pass`, which has not run yet.
template <class Source, class Pass, class E>
auto run_stages(Source&& source, const Pass& pass, const run_context<E, into_image>& run) {
    return materialize(std::forward<Source>(source), pass, run.ex, run.origin);
}
template <class Source, class Pass, class E, class To>
void run_stages(const Source& source, const Pass& pass, const run_context<E, into_view<To>>& run) {
    const image_view<To> target = run.sink.target;
    require_equal("to.width()", target.width(), source.width(), "that of the result");
    require_equal("to.height()", target.height(), source.height(), "that of the result");
    run_pass<typename Source::value_type>(source, target, pass, run.ex, run.origin);
}
template <class Source, class Pass, class E, class Sink, class F, class... Rest>
auto run_stages(Source&& source, const Pass& pass, const run_context<E, Sink>& run, const F& stage,
                const Rest&... rest) {
    using pixel = pass_result<Pass, typename std::remove_cvref_t<Source>::value_type>;
    constexpr bool is_identity = std::is_same_v<Pass, identity_pass>;
    if constexpr (image_filter<F, pixel>) {
        // Only an image is passed on: a callable of any type would also accept a view and write to the caller's
        // pixels.
        if constexpr (is_identity && std::conjunction_v<std::is_same<std::remove_cvref_t<Source>, image<pixel>>,
                                                        std::is_invocable<const F&, Source>>) {
            return run_stages(stage(std::forward<Source>(source)), identity_pass{}, run, rest...);
        } else {
            return run_stages(stage(materialize(std::forward<Source>(source), pass, run.ex, run.origin)),
                              identity_pass{}, run, rest...);
        }
    } else if constexpr (is_identity) {
        return run_stages(std::forward<Source>(source), make_pass<pixel>(stage, source, run.ex), run, rest...);
    } else if constexpr (measured_filter<F, pixel>) {
        image<pixel> seen = materialize(std::forward<Source>(source), pass, run.ex, run.origin);
        const auto next = make_pass<pixel>(stage, seen, run.ex);
        return run_stages(std::move(seen), next, run, rest...);
    } else {
        auto next = make_pass(stage, image_view<const pixel>{}, run.ex);
        return run_stages(std::forward<Source>(source), fused<Pass, decltype(next)>{pass, std::move(next)}, run,
                          rest...);
    }
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
