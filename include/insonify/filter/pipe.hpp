// Filter pipes: `image | f` applies a filter, `f | g` composes a chain; `apply` takes an executor, `apply_into` and
// `apply_in_place` the memory of the result.
//
// Adjacent point-wise stages run as one pass over the image. A measured stage reads the finished image of the stages
// before it and starts the next pass (filter/concept.hpp defines both kinds).
//
// Lambdas and users' classes are filters as they are. One side of `f | g` must be a filter or a chain of the library,
// since the operator is looked up in its namespace; `filter_chain<>{} | f | g` composes two of a user's own.
#pragma once

#include <insonify/filter/detail/run_stages.hpp>

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

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
                return detail::run_stages(std::forward<Source>(source), detail::identity_pass{}, context, each...);
            },
            stages);
    }
};

namespace detail::inline INSONIFY_FLAGS {

template <class T>
inline constexpr bool is_image = false;
template <class T>
inline constexpr bool is_image<image<T>> = true;
template <class T>
inline constexpr bool is_image<image_view<T>> = true;

template <class F>
concept library_filter = requires {
    typename std::remove_cvref_t<F>::is_filter;
};

template <class F>
inline constexpr bool is_chain = false;
template <class... Stages>
inline constexpr bool is_chain<filter_chain<Stages...>> = true;

template <class F>
concept stage = !is_image<std::remove_cvref_t<F>> &&
                (std::is_class_v<std::remove_cvref_t<F>> || std::is_function_v<std::remove_pointer_t<std::decay_t<F>>>);

template <class F>
auto as_stages(F&& f) {
    if constexpr (is_chain<std::remove_cvref_t<F>>)
        return std::forward<F>(f).stages;
    else
        return std::tuple<std::decay_t<F>>(std::forward<F>(f));
}

template <class... Stages>
filter_chain<Stages...> make_chain(std::tuple<Stages...> stages) {
    return {std::move(stages)};
}

template <class Source, class F, class E, class Sink>
auto apply_to(Source&& source, const F& f, E& ex, pixel_origin origin, Sink sink) {
    const run_context<E, Sink> run{ex, origin, sink};
    if constexpr (is_chain<F>)
        return f.run(std::forward<Source>(source), run);
    else
        return run_stages(std::forward<Source>(source), identity_pass{}, run, f);
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Applies a filter; the result is the same bytes for any executor. An image that is moved in is filtered in place
/// where the pixel type stays the same.
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
/// The same for pixels in the caller's memory.
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
/// The same for pixels in the caller's memory.
template <class Pixel, filter_for<std::remove_const_t<Pixel>> F>
auto operator|(image_view<Pixel> in, const F& f) {
    return apply(in, f);
}

// Deleted overloads, so that compilers name the type that is no filter of these pixels, instead of all candidates.
// clang-format off
template <class Pixel, class NoFilter>
void operator|(const image<Pixel>&, const NoFilter&) requires(!filter_for<NoFilter, Pixel>) = delete;
template <class Pixel, class NoFilter>
void operator|(image_view<Pixel>, const NoFilter&) requires(!filter_for<NoFilter, std::remove_const_t<Pixel>>) = delete;
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
