// Filter pipes: `image | f` applies a filter, `f | g` composes a chain; `apply` takes an executor, `apply_into` and
// `apply_in_place` the memory of the result.
//
// Adjacent point-wise stages run as one pass over the image. A measured stage reads the finished image of the stages
// before it and starts the next pass (filter/concept.hpp defines both kinds).
//
// Lambdas and users' classes are filters as they are. One side of `f | g` must declare `is_filter`, as the library's
// filters do, or be a chain; `filter_chain<>{} | f | g` composes others.
#pragma once

#include <insonify/filter/detail/run_pass.hpp>

#include <algorithm>
#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

template <class T>
inline constexpr bool is_image = false;
template <class T>
inline constexpr bool is_image<image<T>> = true;
template <class T>
inline constexpr bool is_image<image_view<T>> = true;

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

/// The pass before the first stage.
struct untouched {
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
    void prepare(const pixel_area& area) {
        prepare_pass(first, area);
        prepare_pass(second, area);
    }
};

template <class Pixel, class F, executor E>
auto make_pass(const F& stage, [[maybe_unused]] image_view<const Pixel> seen, [[maybe_unused]] E& ex) {
    if constexpr (measured_filter<F, Pixel>) {
        if constexpr (requires { stage.pass(seen, ex); }) {
            return stage.pass(seen, ex);
        } else {
            return stage.pass(seen);
        }
    } else if constexpr (requires { stage.pass(); }) {
        return stage.pass();
    } else {
        return pass_by_reference<F>{&stage};
    }
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
    if constexpr (filter_for<F, Pixel>) {
        return chain_takes<typename filter_result<F, Pixel>::type, Rest...>();
    } else {
        return false;
    }
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

template <class T>
image_view<const T> look_at(const image<T>& source) {
    return source;
}
template <class T>
image_view<const T> look_at(image_view<T> source) {
    return source;
}

/// Runs a pass and returns its image: in place where the source is an rvalue of the same pixel type.
template <class Source, class Pass, executor E>
auto materialize(Source&& source, const Pass& pass, E& ex, pixel_origin origin) {
    using from = typename std::remove_cvref_t<Source>::value_type;
    using to = pass_result<Pass, from>;
    constexpr bool owned = std::is_same_v<Source, image<from>>;
    if constexpr (std::is_same_v<Pass, untouched>) {
        return image<from>(std::forward<Source>(source));
    } else if constexpr (owned && std::is_same_v<from, to>) {
        run_pass(look_at(source), source.view(), pass, ex, origin);
        return std::move(source);
    } else {
        image<to> out(source.width(), source.height(), uninitialized{}, memory_of(ex));
        run_pass(look_at(source), out.view(), pass, ex, origin);
        return out;
    }
}

template <class F>
concept library_filter = requires {
    typename std::remove_cvref_t<F>::is_filter;
};

/// Runs the stages on `source` after `pass`, which has not run yet.
template <class Source, class Pass, class E>
auto run_stages(Source&& source, const Pass& pass, const run_context<E, into_image>& run) {
    return materialize(std::forward<Source>(source), pass, run.ex, run.origin);
}
template <class Source, class Pass, class E, class To>
void run_stages(const Source& source, const Pass& pass, const run_context<E, into_view<To>>& run) {
    const image_view<To> target = run.sink.target;
    require(source.width() == target.width(), "to.width()", target.width(), "that of the result");
    require(source.height() == target.height(), "to.height()", target.height(), "that of the result");
    run_pass(look_at(source), target, pass, run.ex, run.origin);
}
template <class Source, class Pass, class E, class Sink, class F, class... Rest>
auto run_stages(Source&& source, const Pass& pass, const run_context<E, Sink>& run, const F& stage,
                const Rest&... rest) {
    using pixel = pass_result<Pass, typename std::remove_cvref_t<Source>::value_type>;
    constexpr bool clean = std::is_same_v<Pass, untouched>;
    if constexpr (image_filter<F, pixel>) {
        if constexpr (clean && std::is_invocable_v<const F&, Source>) {
            return run_stages(stage(std::forward<Source>(source)), untouched{}, run, rest...);
        } else {
            return run_stages(stage(materialize(std::forward<Source>(source), pass, run.ex, run.origin)), untouched{},
                              run, rest...);
        }
    } else if constexpr (clean) {
        return run_stages(std::forward<Source>(source), make_pass(stage, look_at(source), run.ex), run, rest...);
    } else if constexpr (measured_filter<F, pixel>) {
        image<pixel> seen = materialize(std::forward<Source>(source), pass, run.ex, run.origin);
        const auto next = make_pass(stage, look_at(seen), run.ex);
        return run_stages(std::move(seen), next, run, rest...);
    } else {
        auto next = make_pass(stage, image_view<const pixel>{}, run.ex);
        return run_stages(std::forward<Source>(source), fused<Pass, decltype(next)>{pass, std::move(next)}, run,
                          rest...);
    }
}

}  // namespace detail::inline INSONIFY_FLAGS

/// A sequence of filters, composed by `f | g`. Stages are stored by value; a chain may be applied to any number of
/// images.
template <class... Stages>
struct filter_chain {
    using is_filter = std::true_type;
    std::tuple<Stages...> stages;

    template <class Pixel>
        requires(detail::chain_takes<Pixel, Stages...>())
    INSONIFY_TAGGED auto operator()(image<Pixel> in) const {
        const serial_executor ex;
        return run(std::move(in), detail::run_context<const serial_executor, detail::into_image>{ex, {}, {}});
    }

    template <class Source, class Context>
    INSONIFY_TAGGED auto run(Source&& source, const Context& context) const {
        return std::apply(
            [&](const Stages&... each) {
                return detail::run_stages(std::forward<Source>(source), detail::untouched{}, context, each...);
            },
            stages);
    }
};

namespace detail::inline INSONIFY_FLAGS {

template <class F>
inline constexpr bool is_chain = false;
template <class... Stages>
inline constexpr bool is_chain<filter_chain<Stages...>> = true;

template <class F>
concept stage = !is_image<std::remove_cvref_t<F>> &&
                (std::is_class_v<std::remove_cvref_t<F>> || std::is_function_v<std::remove_pointer_t<std::decay_t<F>>>);

template <class F>
auto as_stages(F&& f) {
    if constexpr (is_chain<std::remove_cvref_t<F>>) {
        return std::forward<F>(f).stages;
    } else {
        return std::tuple<std::decay_t<F>>(std::forward<F>(f));
    }
}

template <class... Stages>
filter_chain<Stages...> make_chain(std::tuple<Stages...> stages) {
    return {std::move(stages)};
}

template <class Source, class F, class E, class Sink>
auto apply_to(Source&& source, const F& f, E& ex, pixel_origin origin, Sink sink) {
    const run_context<E, Sink> run{ex, origin, sink};
    if constexpr (is_chain<F>) {
        return f.run(std::forward<Source>(source), run);
    } else {
        return run_stages(std::forward<Source>(source), untouched{}, run, f);
    }
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Applies a filter; the result is the same bytes for any executor. An image that is moved in is filtered in place
/// where the pixel type stays.
///
/// @param origin  position of the image's first pixel in a larger one: parts that are filtered one by one get the noise
///                of the whole. Measured filters measure the part.
/// @throws what a stage throws for its parameters, before the first pixel of its pass
template <class Pixel, filter_for<Pixel> F, executor_argument Executor = serial_executor>
auto apply(const image<Pixel>& in, const F& f, Executor&& ex = serial_executor{}, pixel_origin origin = {}) {
    return detail::apply_to(in, f, ex, origin, detail::into_image{});
}
/// The same, in the memory of the image where the pixel type stays the same.
template <class Pixel, filter_for<Pixel> F, executor_argument Executor = serial_executor>
auto apply(image<Pixel>&& in, const F& f, Executor&& ex = serial_executor{}, pixel_origin origin = {}) {
    return detail::apply_to(std::move(in), f, ex, origin, detail::into_image{});
}
/// The same of pixels in memory of your own.
template <class Pixel, filter_for<std::remove_const_t<Pixel>> F, executor_argument Executor = serial_executor>
auto apply(image_view<Pixel> in, const F& f, Executor&& ex = serial_executor{}, pixel_origin origin = {}) {
    return detail::apply_to(in, f, ex, origin, detail::into_image{});
}

/// Filters into the caller's memory. `to` is exactly `in`, or does not overlap it.
/// @throws invalid_input if `to` does not have the size of the result; and as `apply`
template <class Pixel, class To, filter_for<std::remove_const_t<Pixel>> F, executor_argument Executor = serial_executor>
    requires(std::same_as<typename detail::filter_result<F, std::remove_const_t<Pixel>>::type, To>)
void apply_into(image_view<Pixel> in, image_view<To> to, const F& f, Executor&& ex = serial_executor{},
                pixel_origin origin = {}) {
    detail::apply_to(in, f, ex, origin, detail::into_view<To>{to});
}

/// Filters in place.
template <class Pixel, filter_for<Pixel> F, executor_argument Executor = serial_executor>
    requires(std::same_as<typename detail::filter_result<F, Pixel>::type, Pixel>)
void apply_in_place(image_view<Pixel> pixels, const F& f, Executor&& ex = serial_executor{}, pixel_origin origin = {}) {
    apply_into(pixels, pixels, f, ex, origin);
}

/// `image | filter`: the filtered image, on the calling thread.
template <class Pixel, filter_for<Pixel> F>
auto operator|(const image<Pixel>& in, const F& f) {
    return apply(in, f);
}
/// The same, in the memory of the image where the pixel type stays the same.
template <class Pixel, filter_for<Pixel> F>
auto operator|(image<Pixel>&& in, const F& f) {
    return apply(std::move(in), f);
}
/// The same of pixels in memory of your own.
template <class Pixel, filter_for<std::remove_const_t<Pixel>> F>
auto operator|(image_view<Pixel> in, const F& f) {
    return apply(in, f);
}

// Deleted overloads, so that compilers name the filter that does not accept these pixels.
// clang-format off
template <class Pixel, detail::library_filter F>
void operator|(const image<Pixel>&, const F&) requires(!filter_for<F, Pixel>) = delete;
template <class Pixel, detail::library_filter F>
void operator|(image_view<Pixel>, const F&) requires(!filter_for<F, std::remove_const_t<Pixel>>) = delete;
// clang-format on

/// `filter | filter`: a chain of both. One of them must be a filter of the library or a chain.
template <detail::stage F, detail::stage G>
    requires(detail::library_filter<F> || detail::library_filter<G>)
auto operator|(F&& f, G&& g) {
    return detail::make_chain(
        std::tuple_cat(detail::as_stages(std::forward<F>(f)), detail::as_stages(std::forward<G>(g))));
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
