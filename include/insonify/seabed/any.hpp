// Any seabed, by value: the library's models and users' own alike.
//
// The model is stored once, immutable and shared by copies; calls go through a virtual function once per row, never per
// point. No list of types is kept anywhere: what a program does not use, it does not compile.
#pragma once

#include <insonify/seabed/model.hpp>
#include <insonify/seabed/none.hpp>

#include <memory>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// A prepared seabed of any model; shares ownership of the model.
class any_sampler {
  public:
    /// @throws invalid_input for parameters of the model out of their range
    template <model M>
    explicit any_sampler(std::shared_ptr<const M> owner)
        : held_(std::make_shared<const prepared<M>>(seabed::prepare(*owner), owner)) {}
    any_sampler() = default;

    void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        if (held_ != nullptr) return held_->row(line, heights, types);
        std::fill(heights.begin(), heights.end(), std::numeric_limits<float>::quiet_NaN());
        std::fill(types.begin(), types.end(), type::sand);
    }
    height_range range() const { return held_ != nullptr ? held_->range() : height_range{}; }

  private:
    struct interface_type {
        virtual ~interface_type() = default;
        virtual void row(const scanline& line, std::span<float> heights, std::span<type> types) const = 0;
        virtual height_range range() const = 0;
    };
    template <class M>
    struct prepared final : interface_type {
        using sampler_type = decltype(seabed::prepare(std::declval<const M&>()));
        sampler_type sampler;
        std::shared_ptr<const M> owner;

        prepared(sampler_type s, std::shared_ptr<const M> m) : sampler(std::move(s)), owner(std::move(m)) {}
        void row(const scanline& line, std::span<float> heights, std::span<type> types) const override {
            sampler.row(line, heights, types);
        }
        height_range range() const override { return detail::range_of(sampler); }
    };

    std::shared_ptr<const interface_type> held_;
};

/// A seabed of any model, or none: `any bottom = ripples{.wavelength = 0.6f};`. It is a model itself.
class any {
  public:
    /// No seabed: for scenes that bring theirs as a mesh.
    any() = default;
    any(none) {}
    /// @param m  copied once; copies of `any` share it
    template <model M>
        requires(!std::same_as<M, any> && !std::same_as<M, none>)
    any(M m) : held_(std::make_shared<const holder<M>>(std::move(m))) {}

    /// Whether there is no seabed.
    bool empty() const { return held_ == nullptr; }
    /// The model, or null if it is of another type.
    template <class M>
    const M* get_if() const {
        return held_ != nullptr && held_->tag() == &tag_of<M> ? &static_cast<const holder<M>&>(*held_).value : nullptr;
    }

    /// The sampler shares the model, so that it may outlive this object.
    /// @throws invalid_input for parameters of the model out of their range
    any_sampler prepare() const { return held_ != nullptr ? held_->prepare(held_) : any_sampler(); }
    /// See the functions of the same names in model.hpp.
    std::optional<type> only_type() const { return held_ != nullptr ? held_->only_type() : std::nullopt; }
    std::vector<type_properties> legend() const {
        return held_ != nullptr ? held_->legend() : std::vector<type_properties>{};
    }
    float sink_depth() const { return held_ != nullptr ? held_->sink_depth() : 0; }

    float operator()(double x, double y) const { return at(prepare(), x, y).height; }
    type type_at(double x, double y) const { return at(prepare(), x, y).kind; }

  private:
    struct interface_type {
        virtual ~interface_type() = default;
        virtual const void* tag() const = 0;
        virtual any_sampler prepare(const std::shared_ptr<const interface_type>& self) const = 0;
        virtual std::optional<type> only_type() const = 0;
        virtual std::vector<type_properties> legend() const = 0;
        virtual float sink_depth() const = 0;
    };
    template <class M>
    inline static constexpr char tag_of = 0;
    template <class M>
    struct holder final : interface_type {
        M value;

        explicit holder(M m) : value(std::move(m)) {}
        const void* tag() const override { return &tag_of<M>; }
        any_sampler prepare(const std::shared_ptr<const interface_type>& self) const override {
            return any_sampler(std::shared_ptr<const M>(self, &value));
        }
        std::optional<type> only_type() const override { return seabed::only_type(value); }
        std::vector<type_properties> legend() const override { return legend_of(value); }
        float sink_depth() const override { return sink_depth_of(value); }
    };

    std::shared_ptr<const interface_type> held_;
};

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
