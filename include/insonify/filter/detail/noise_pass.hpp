// Noise laws as filter passes: draws for runs of a row, and the pass that applies a law to every pixel type.
//
// Laws are defined on floats in [0, 1]. Codes of 8 and 16 bits are converted to floats and back, as MATLAB's imnoise
// does; each channel of a colour has independent noise. Draws do not depend on where a run begins.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/core/quantize.hpp>
#include <insonify/core/random.hpp>
#include <insonify/core/simd/random_lanes.hpp>
#include <insonify/filter/concept.hpp>

#include <concepts>
#include <cstdint>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// One random stream per kind of noise. Changing a number changes the noise of every seed.
enum class noise_stream : std::uint32_t {
    gaussian = 0x6E6F6900,
    speckle,
    gaussian_speckle,
    rayleigh,
    poisson,
    salt_and_pepper,
    gamma_speckle,
    k_speckle,
    rician,
    texture
};

/// Key of a filter's random draws; the pixel's position is in the counter.
struct noise_key {
    philox_key key;
    std::uint32_t frame;

    noise_key(std::uint64_t seed, noise_stream stream, std::uint32_t frame_)
        : key(stream_key(seed, static_cast<std::uint32_t>(stream))), frame(frame_) {}
};

/// A run of pixels of one channel.
struct noise_run {
    int x, y;               // of the first pixel
    int count;              // 1 to run_length
    std::uint32_t channel;  // 0 to 2
};

/// Clips to [0, 1]; NaN stays NaN.
template <int N>
INSONIFY_INLINE void clip_lanes(lanes<float, N>& value) {
    value = value < 0.0f ? lanes<float, N>{} : value;
    value = value > 1.0f ? lanes<float, N>{} + 1.0f : value;
}

/// Pixel types that noise applies to: floats in [0, 1], codes, and colours of them.
template <class T>
inline constexpr bool is_noise_color = false;
template <countable_pixel T>
inline constexpr bool is_noise_color<rgb<T>> = true;
template <class T>
concept noise_pixel = countable_pixel<T> || is_noise_color<T>;

inline void to_floats(const float* from, float* to, int count, std::size_t step) {
    for (int i = 0; i < count; ++i) to[i] = from[static_cast<std::size_t>(i) * step];
}
template <pixel_code Code>
void to_floats(const Code* from, float* to, int count, std::size_t step) {
    const auto size = static_cast<std::size_t>(count);
    if (step == 1) return dequantize_row(std::span<const Code>(from, size), std::span<float>(to, size));
    for (int i = 0; i < count; ++i) to[i] = dequantize(from[static_cast<std::size_t>(i) * step]);
}

/// Applies a noise law, `law.row(from, to, run)` on floats, to pixels of any type.
template <class Law>
class noise_pass {
  public:
    explicit noise_pass(Law law) : law_(std::move(law)) {}

    template <noise_pixel Pixel>
    Pixel operator()(const Pixel& pixel, int x, int y) {
        Pixel result{};
        row(&pixel, &result, 1, x, y);
        return result;
    }

    template <noise_pixel Pixel>
    void row(const Pixel* from, Pixel* to, int count, int x, int y) {
        if constexpr (std::same_as<Pixel, float>) {
            law_.row(from, to, {x, y, count, 0});
        } else if constexpr (pixel_code<Pixel>) {
            channel(from, to, 1, {x, y, count, 0});
        } else {
            if (from != to) std::copy_n(from, count, to);
            channel(&to->r, &to->r, 3, {x, y, count, 0});
            channel(&to->g, &to->g, 3, {x, y, count, 1});
            channel(&to->b, &to->b, 3, {x, y, count, 2});
        }
    }

    void prepare(const pixel_area& area) { law_.prepare(area); }
    int rows_above() const { return detail::rows_above(law_); }

  private:
    template <countable_pixel Channel>
    void channel(const Channel* from, Channel* to, std::size_t step, const noise_run& run) {
        float values[run_length];
        to_floats(from, values, run.count, step);
        law_.row(values, values, run);
        if constexpr (std::same_as<Channel, float>) {
            for (int i = 0; i < run.count; ++i) to[static_cast<std::size_t>(i) * step] = values[i];
        } else {
            if (step == 1) return quantize_row(values, to, run.count);
            Channel codes[run_length];
            quantize_row(values, codes, run.count);
            for (int i = 0; i < run.count; ++i) to[static_cast<std::size_t>(i) * step] = codes[i];
        }
    }

    Law law_;
};

/// Policies that turn four random words into four draws.
struct normal_draws {
    template <int N>
    static INSONIFY_INLINE void draw(lanes<float, N> (&into)[4], const lanes<std::uint32_t, N> (&word)[4]) {
        normal_lanes<N>(into[0], into[1], word[0], word[1]);
        normal_lanes<N>(into[2], into[3], word[2], word[3]);
    }
};
struct symmetric_draws {
    template <int N>
    static INSONIFY_INLINE void draw(lanes<float, N> (&into)[4], const lanes<std::uint32_t, N> (&word)[4]) {
        unroll<4>([&](int i) INSONIFY_INLINE_LAMBDA { symmetric_lanes<N>(into[i], word[i]); });
    }
};
struct unit_draws {
    template <int N>
    static INSONIFY_INLINE void draw(lanes<float, N> (&into)[4], const lanes<std::uint32_t, N> (&word)[4]) {
        unroll<4>([&](int i) INSONIFY_INLINE_LAMBDA { unit_lanes<N>(into[i], word[i]); });
    }
};

/// The draws of a run of a row; four pixels in a row share a block of Philox.
template <class Draws>
struct draw_kernel {
    static constexpr int avx512_lanes = 16;

    float* into;
    int count;
    std::uint32_t counter[4];
    philox_key key;

    template <int N>
    INSONIFY_INLINE void run() const {
        for (int i = 0; i < count; i += 4 * N) {
            const std::uint32_t at[4] = {counter[0] + static_cast<std::uint32_t>(i / 4), counter[1], counter[2],
                                         counter[3]};
            lanes<std::uint32_t, N> word[4];
            philox_words<N>(word, at, key[0], key[1]);
            lanes<float, N> draw[4];
            Draws::template draw<N>(draw, word);
            store_draws<N>(into + i, draw);
        }
    }
};

/// Holds the draws of a run: up to 3 before it, from the start of its first Philox block, and up to 63 unused ones
/// after it, from the last vectors.
using draw_buffer = float[run_length + 64];

/// Fills `buffer` with independent draws of a field and returns a pointer to that of the run's first pixel.
template <class Draws>
float* white_draws(draw_buffer& buffer, const noise_key& noise, std::uint32_t field, const noise_run& run) {
    const int before = run.x & 3;
    dispatch(draw_kernel<Draws>{buffer,
                                run.count + before,
                                {static_cast<std::uint32_t>(run.x >> 2), static_cast<std::uint32_t>(run.y),
                                 run.channel | field << 2, noise.frame},
                                noise.key},
             best_isa());
    return buffer + before;
}

/// Draws of filters whose noise has no correlation length.
template <class Draws>
struct independent_draws {
    noise_key noise;

    const float* row(draw_buffer& buffer, std::uint32_t field, const noise_run& run) const {
        return white_draws<Draws>(buffer, noise, field, run);
    }
};

/// to = clip(rule(clip(from), draw, scale)).
template <class Rule>
struct rule_kernel {
    Rule rule;
    const float* from;
    const float* draw;
    const float* scale;
    float* to;
    int count;

    template <int N>
    INSONIFY_INLINE void run() const {
        const rule_kernel own = *this;  // local copy, so that stores cannot alias it
        int i = 0;
        for (; i + N <= own.count; i += N) own.at<N>(i);
        for (; i < own.count; ++i) own.at<1>(i);
    }

  private:
    template <int N>
    INSONIFY_INLINE void at(int i) const {
        lanes<float, N> value, drawn, scaled;
        load(value, from + i);
        load(drawn, draw + i);
        load(scaled, scale + i);
        clip_lanes<N>(value);
        rule.template apply<N>(value, drawn, scaled);
        clip_lanes<N>(value);
        store(to + i, value);
    }
};

template <class Rule>
void apply_rule(const Rule& rule, const float* from, const float* draw, const float* scale, float* to, int count) {
    dispatch(rule_kernel<Rule>{rule, from, draw, scale, to, count}, best_isa());
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
