// Type-erased seabed: holds any model, the library's or a user's.
//
// The model is immutable and shared by copies. Evaluation takes one virtual call per row. There is no list of types, so
// models that a program does not use are not compiled.
#pragma once

#include <insonify/seabed/model.hpp>
#include <insonify/seabed/none.hpp>

#include <memory>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

namespace detail {

struct sampler_interface {
    virtual ~sampler_interface() = default;
    virtual void row(const scanline& line, std::span<float> heights, std::span<type> types) const = 0;
    virtual height_range range() const = 0;
};

}  // namespace detail

/// A prepared seabed of any model; shares ownership of the model.
class any_sampler {
  public:
    any_sampler() = default;
    INSONIFY_MEMBER explicit any_sampler(std::shared_ptr<const detail::sampler_interface> held)
        : held_(std::move(held)) {}

    INSONIFY_TAGGED void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        if (held_ != nullptr) return held_->row(line, heights, types);
        std::fill(heights.begin(), heights.end(), std::numeric_limits<float>::quiet_NaN());
        std::fill(types.begin(), types.end(), type::sand);
    }
    INSONIFY_TAGGED void row(const scanline& line, std::span<float> heights) const { row(line, heights, {}); }
    INSONIFY_MEMBER height_range range() const { return held_ != nullptr ? held_->range() : height_range{}; }

  private:
    std::shared_ptr<const detail::sampler_interface> held_;
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

template <typed_sampler S>
struct held_sampler final : sampler_interface {
    S sampler;
    std::shared_ptr<const void> owner;

    held_sampler(S s, std::shared_ptr<const void> o) : sampler(std::move(s)), owner(std::move(o)) {}
    void row(const scanline& line, std::span<float> heights, std::span<type> types) const override {
        sampler.row(line, heights, types);
    }
    height_range range() const override { return range_of(sampler); }
};

/// @param owner  kept alive for as long as the sampler, which may refer to it
template <typed_sampler S>
any_sampler hold_sampler(S sampler, std::shared_ptr<const void> owner = nullptr) {
    return any_sampler(std::make_shared<const held_sampler<S>>(std::move(sampler), std::move(owner)));
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
    return std::make_shared<const detail::held_model<M>>(std::move(m));
}

}  // namespace INSONIFY_FLAGS

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
