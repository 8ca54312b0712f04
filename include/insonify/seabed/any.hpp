// Type-erased seabed: holds any model, the library's or a user's.
//
// The model is immutable and shared by copies. Evaluation takes one indirect call per row. There is no list of types,
// so models that a program does not use are not compiled.
#pragma once

#include <insonify/seabed/model.hpp>
#include <insonify/seabed/none.hpp>

#include <concepts>
#include <memory>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// A prepared seabed of any model; shares ownership of the model.
class any_sampler {
  public:
    using row_function = void(const void* sampler, const scanline&, std::span<float> heights, std::span<type> types);

    any_sampler() = default;
    /// @param evaluate  is called with the sampler
    /// @param range     of the heights
    INSONIFY_MEMBER any_sampler(std::shared_ptr<const void> sampler, row_function* evaluate, const height_range& range)
        : held_(std::move(sampler)), evaluate_(evaluate), range_(range) {}

    INSONIFY_TAGGED void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        if (held_ != nullptr) return evaluate_(held_.get(), line, heights, types);
        std::fill(heights.begin(), heights.end(), std::numeric_limits<float>::quiet_NaN());
        std::fill(types.begin(), types.end(), type::sand);
    }
    INSONIFY_TAGGED void row(const scanline& line, std::span<float> heights) const { row(line, heights, {}); }
    INSONIFY_MEMBER height_range range() const { return range_; }

  private:
    std::shared_ptr<const void> held_;
    row_function* evaluate_ = nullptr;
    height_range range_;
};

namespace detail {

/// Its address identifies a type.
template <class M>
inline constexpr char tag_of = 0;

struct model_interface {
    virtual ~model_interface() = default;
    virtual const void* get(const void* tag) const = 0;  ///< the model if `tag` identifies its type, else null
    virtual any_sampler prepare(const std::shared_ptr<const model_interface>& self) const = 0;
    virtual std::optional<type> only_type() const = 0;
    virtual std::vector<type_properties> legend() const = 0;
    virtual float sink_depth() const = 0;
};

}  // namespace detail

namespace detail::inline INSONIFY_FLAGS {

/// Erases the type of a sampler. An `any_sampler` is returned as it is: it owns what it refers to. The call goes
/// through a function pointer because compilers drop unused virtual functions late: programs would pay for seabeds that
/// they don't use.
/// @param owner  kept alive for as long as the sampler, which may refer to it
template <typed_sampler S>
any_sampler hold_sampler(S sampler, std::shared_ptr<const void> owner = nullptr) {
    if constexpr (std::same_as<S, any_sampler>) return sampler;
    struct held {
        S sampler;
        std::shared_ptr<const void> owner;
    };
    const height_range range = range_of(sampler);
    // With a function as deleter, all samplers share one type of control block.
    const void* const made = new held{std::move(sampler), std::move(owner)};
    return {std::shared_ptr<const void>(
                made, +[](const void* to) { delete static_cast<const held*>(to); }),
            [](const void* from, const scanline& line, std::span<float> heights, std::span<type> types) {
                static_cast<const held*>(from)->sampler.row(line, heights, types);
            },
            range};
}

template <class M>
struct held_model final : model_interface {
    M value;

    explicit held_model(M m) : value(std::move(m)) {}
    const void* get(const void* tag) const override { return tag == &tag_of<M> ? &value : nullptr; }
    any_sampler prepare(const std::shared_ptr<const model_interface>& self) const override {
        return hold_sampler(seabed::prepare(value), self);
    }
    std::optional<type> only_type() const override { return seabed::only_type(value); }
    std::vector<type_properties> legend() const override { return legend_of(value); }
    float sink_depth() const override { return sink_depth_of(value); }
};

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// A model for `any` to share. In the compiled form the built-in models have overloads, compiled once.
template <model M>
std::shared_ptr<const detail::model_interface> hold(M m) {
    // By way of a unique pointer, all models have the same type of control block.
    return std::unique_ptr<const detail::model_interface>(new detail::held_model<M>(std::move(m)));
}

}  // namespace INSONIFY_FLAGS

namespace detail {

template <class M>
concept labelled = requires(const M& m) {
    m.kind;
};
template <class M>
concept sampled = requires(const M& m) {
    sampler_of(m);
};
/// A height as a function of x and y.
template <class M>
concept called_by_point = std::invocable<const M&, double, double>;
/// A type with a part of the members of a model, or a lambda in its stead, which get a readable error.
template <class M>
concept incomplete_model = !model<M> && (labelled<M> || sampled<M> || called_by_point<M>);

}  // namespace detail

/// A seabed of any model, or none: `any bottom = ripples{.wavelength = 0.6f};`. It is a model itself.
class any {
  public:
    /// No seabed: for scenes that bring theirs as a mesh.
    any() = default;
    INSONIFY_MEMBER any(none) {}
    /// @param m  copied once; copies of `any` share it
    template <model M>
        requires(!std::same_as<M, any> && !std::same_as<M, none>)
    INSONIFY_MEMBER any(M m) : held_(hold(std::move(m))) {}
    /// Says what a model lacks, where a constraint would only say that there is no conversion.
    template <detail::incomplete_model M>
    any(const M&) {
        static_assert(model<M>,
                      "a seabed has row(const scanline&, std::span<float>) const and kind, a seabed::type or "
                      "type_properties: see seabed/model.hpp");
    }

    /// Whether there is no seabed.
    INSONIFY_MEMBER bool empty() const { return held_ == nullptr; }
    /// The model, or null if it is of another type.
    template <class M>
    INSONIFY_MEMBER const M* get_if() const {
        return held_ != nullptr ? static_cast<const M*>(held_->get(&detail::tag_of<M>)) : nullptr;
    }

    /// The sampler shares the model, so that it may outlive this object.
    /// @throws invalid_input for parameters of the model out of their range
    INSONIFY_MEMBER any_sampler prepare() const { return held_ != nullptr ? held_->prepare(held_) : any_sampler(); }
    /// See the functions of the same names in model.hpp.
    INSONIFY_MEMBER std::optional<type> only_type() const {
        return held_ != nullptr ? held_->only_type() : std::nullopt;
    }
    INSONIFY_MEMBER std::vector<type_properties> legend() const {
        return held_ != nullptr ? held_->legend() : std::vector<type_properties>{};
    }
    INSONIFY_MEMBER float sink_depth() const { return held_ != nullptr ? held_->sink_depth() : 0; }

  private:
    std::shared_ptr<const detail::model_interface> held_;
};

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
