// Filters by `|`: `image | f` applies, `f | g` makes a chain without touching a pixel, `apply` brings an executor.
//
// Point-wise neighbours run as one sweep over the image, and a measured stage is the first of the sweep behind it
// (filter/concept.hpp says which is which).
//
// A user's lambda or class is a filter as it is. One of the two sides of `f | g` must be a filter of the library (they
// declare `is_filter`) or a chain; `filter_chain<>{} | mine | yours` starts one without.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/core/image.hpp>
#include <insonify/filter/concept.hpp>

#include <algorithm>
#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

namespace detail {

template <class T>
inline constexpr bool is_image = false;
template <class T>
inline constexpr bool is_image<image<T>> = true;
template <class T>
inline constexpr bool is_image<image_view<T>> = true;

/// A stage that is itself the function of the pixel; it outlives the sweep.
template <class F>
struct pass_by_reference {
    const F* stage;
    template <class Pixel>
        requires(pixel_function<const F, Pixel>)
    INSONIFY_INLINE auto operator()(const Pixel& pixel, int x, int y) const { return call_pixel(*stage, pixel, x, y); }
};

/// The pass before the first stage.
struct untouched {
    template <class Pixel>
    INSONIFY_INLINE Pixel operator()(const Pixel& pixel, int, int) const {
        return pixel;
    }
};

/// Two passes in one.
template <class First, class Second>
struct fused {
    First first;
    Second second;
    template <class Pixel>
    INSONIFY_INLINE auto operator()(const Pixel& pixel, int x, int y) {
        return call_pixel(second, call_pixel(first, pixel, x, y), x, y);
    }
};

template <class Pass, class Pixel>
using pass_result = decltype(call_pixel(std::declval<Pass&>(), std::declval<const Pixel&>(), 0, 0));

template <class Pixel, class F>
auto make_pass(const F& stage, [[maybe_unused]] image_view<const Pixel> seen) {
    if constexpr (measured_filter<F, Pixel>) {
        return stage.pass(seen);
    } else if constexpr (requires { stage.pass(); }) {
        return stage.pass();
    } else {
        return pass_by_reference<F>{&stage};
    }
}

template <class F, class Pixel>
struct filter_result {
    using type = pass_result<decltype(make_pass<Pixel>(std::declval<const F&>(), {})), Pixel>;
};
template <class F, class Pixel>
    requires image_filter<F, Pixel>
struct filter_result<F, Pixel> {
    using type =
        typename std::remove_cvref_t<decltype(std::declval<const F&>()(std::declval<image<Pixel>>()))>::value_type;
};

/// Whether each stage takes what the one before it makes.
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

/// One sweep: rows in runs of some 64 Ki pixels, in any order; `to` may be `from`.
template <class From, class To, class Pass, executor E>
void sweep(image_view<const From> from, image_view<To> to, const Pass& pass, E& ex) {
    const int rows = 65536 / (std::max)(from.width(), 1) + 1;
    bulk_ranges(ex, static_cast<std::size_t>(from.height()), static_cast<std::size_t>(rows),
                [&](std::size_t first, std::size_t last) {
                    Pass own = pass;
                    for (int y = static_cast<int>(first); y < static_cast<int>(last); ++y) {
                        const From* const source = from.row(y).data();
                        To* const target = to.row(y).data();
                        for (int x = 0; x < from.width(); ++x) target[x] = call_pixel(own, source[x], x, y);
                    }
                });
}

template <class T>
image_view<const T> look_at(const image<T>& source) {
    return source;
}
template <class T>
image_view<const T> look_at(image_view<T> source) {
    return source;
}

/// The pixels behind a pass, in the source's own memory where that is ours and fits.
template <class Source, class Pass, executor E>
auto materialize(Source&& source, const Pass& pass, E& ex) {
    using from = typename std::remove_cvref_t<Source>::value_type;
    using to = pass_result<Pass, from>;
    constexpr bool owned = std::is_same_v<Source, image<from>>;
    if constexpr (std::is_same_v<Pass, untouched>) {
        return image<from>(std::forward<Source>(source));
    } else if constexpr (owned && std::is_same_v<from, to>) {
        sweep(look_at(source), source.view(), pass, ex);
        return std::move(source);
    } else {
        image<to> out(source.width(), source.height());
        sweep(look_at(source), out.view(), pass, ex);
        return out;
    }
}

/// Runs the stages on `source`, of which `pass` is still to be done.
template <class Source, class Pass, executor E>
auto run_stages(Source&& source, const Pass& pass, E& ex) {
    return materialize(std::forward<Source>(source), pass, ex);
}
template <class Source, class Pass, executor E, class F, class... Rest>
auto run_stages(Source&& source, const Pass& pass, E& ex, const F& stage, const Rest&... rest) {
    using pixel = pass_result<Pass, typename std::remove_cvref_t<Source>::value_type>;
    constexpr bool clean = std::is_same_v<Pass, untouched>;
    if constexpr (image_filter<F, pixel>) {
        if constexpr (clean && std::is_invocable_v<const F&, Source>) {
            return run_stages(stage(std::forward<Source>(source)), untouched{}, ex, rest...);
        } else {
            return run_stages(stage(materialize(std::forward<Source>(source), pass, ex)), untouched{}, ex, rest...);
        }
    } else if constexpr (clean) {
        return run_stages(std::forward<Source>(source), make_pass(stage, look_at(source)), ex, rest...);
    } else if constexpr (measured_filter<F, pixel>) {
        image<pixel> seen = materialize(std::forward<Source>(source), pass, ex);
        const auto next = stage.pass(look_at(seen));
        return run_stages(std::move(seen), next, ex, rest...);
    } else {
        auto next = make_pass(stage, image_view<const pixel>{});
        return run_stages(std::forward<Source>(source), fused<Pass, decltype(next)>{pass, std::move(next)}, ex,
                          rest...);
    }
}

}  // namespace detail

/// Filters in a row, made by `f | g`. Stages are kept by value; the same chain serves any number of images.
template <class... Stages>
struct filter_chain {
    using is_filter = std::true_type;
    std::tuple<Stages...> stages;

    template <class Pixel>
        requires(detail::chain_takes<Pixel, Stages...>())
    auto operator()(image<Pixel> in) const { return run(std::move(in), serial_executor{}); }

    template <class Source, executor_argument Executor>
    auto run(Source&& source, Executor&& ex) const {
        return std::apply(
            [&](const Stages&... each) {
                return detail::run_stages(std::forward<Source>(source), detail::untouched{}, ex, each...);
            },
            stages);
    }
};

namespace detail {

template <class F>
inline constexpr bool is_chain = false;
template <class... Stages>
inline constexpr bool is_chain<filter_chain<Stages...>> = true;

template <class F>
concept library_filter = requires {
    typename std::remove_cvref_t<F>::is_filter;
};

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

template <class Source, class F, class E>
auto apply_to(Source&& source, const F& f, E& ex) {
    if constexpr (is_chain<F>) {
        return f.run(std::forward<Source>(source), ex);
    } else {
        return run_stages(std::forward<Source>(source), untouched{}, ex, f);
    }
}

}  // namespace detail

/// The filtered image, its rows shared out by the executor; the same bytes for any executor. An image that is moved in
/// lends its memory to the result where the pixel type stays.
/// @throws whatever a stage says of its parameters, before the first pixel of its sweep
template <class Pixel, filter_for<Pixel> F, executor_argument Executor = serial_executor>
auto apply(const image<Pixel>& in, const F& f, Executor&& ex = serial_executor{}) {
    return detail::apply_to(in, f, ex);
}
template <class Pixel, filter_for<Pixel> F, executor_argument Executor = serial_executor>
auto apply(image<Pixel>&& in, const F& f, Executor&& ex = serial_executor{}) {
    return detail::apply_to(std::move(in), f, ex);
}
template <class Pixel, filter_for<std::remove_const_t<Pixel>> F, executor_argument Executor = serial_executor>
auto apply(image_view<Pixel> in, const F& f, Executor&& ex = serial_executor{}) {
    return detail::apply_to(in, f, ex);
}

/// `image | filter`: the filtered image, on the calling thread.
template <class Pixel, filter_for<Pixel> F>
auto operator|(const image<Pixel>& in, const F& f) {
    return apply(in, f);
}
template <class Pixel, filter_for<Pixel> F>
auto operator|(image<Pixel>&& in, const F& f) {
    return apply(std::move(in), f);
}
template <class Pixel, filter_for<std::remove_const_t<Pixel>> F>
auto operator|(image_view<Pixel> in, const F& f) {
    return apply(in, f);
}

/// `filter | filter`: both in a row, for later. One of them must be a filter of the library or a chain.
template <detail::stage F, detail::stage G>
    requires(detail::library_filter<F> || detail::library_filter<G>)
auto operator|(F&& f, G&& g) {
    return detail::make_chain(
        std::tuple_cat(detail::as_stages(std::forward<F>(f)), detail::as_stages(std::forward<G>(g))));
}

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
