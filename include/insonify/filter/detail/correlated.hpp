// Correlated draws: white noise through a separable filter, row by row.
#pragma once

#include <insonify/core/detail/correlation.hpp>
#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/detail/tap_kernels.hpp>
#include <insonify/filter/detail/noise_pass.hpp>
#include <insonify/filter/parameter.hpp>

#include <optional>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

inline void require_correlation(const char* name, const correlation_length& length) {
    for (const float pixels : {length.x, length.y}) require_range(name, pixels, 0, 16, "0 to 16 pixels");
}

/// Draws, one for each pixel and field, correlated along rows and columns. A draw depends on the pixel's position
/// alone. Consecutive rows reuse the blurred rows that both need.
template <class Draws>
class correlated_draws {
  public:
    /// @param x, y  taps of the filters along rows and columns
    correlated_draws(noise_key noise, dynamic_array<float> x, dynamic_array<float> y)
        : noise_(noise), taps_x_(std::move(x)), taps_y_(std::move(y)) {}

    /// See filter/concept.hpp.
    int rows_above() const { return 2 * (static_cast<int>(taps_y_.size()) - 1); }

    /// The draws of a run, in `into`.
    void row(float* into, std::uint32_t field, const noise_run& run) {
        strip& s = strip_of(field, run);
        const int reach = static_cast<int>(taps_y_.size()) - 1, rows = 2 * reach + 1;
        // The strip holds the rows up to y + reach, blurred along x, in a ring.
        const bool follows = s.filled && run.y > s.y && run.y - s.y < rows;
        for (int y = follows ? s.y + reach + 1 : run.y - reach; y <= run.y + reach; ++y)
            blur_row(s.at(y), field, {run.x, y, run.count, run.channel});
        s.y = run.y;
        s.filled = true;
        rows_.clear();
        for (int j = -reach; j <= reach; ++j) rows_.push_back(s.at(run.y + j));
        dispatch(taps_across_rows{taps_y_, rows_, into, static_cast<std::size_t>(run.count)}, best_isa());
    }

  private:
    /// The last rows of a column of runs.
    struct strip {
        std::uint32_t field, channel;
        int x, count;
        int y = 0;
        bool filled = false;
        dynamic_array<float> ring;

        float* at(int row) {
            const auto rows = static_cast<std::int64_t>(ring.size() / run_length);
            const std::int64_t place = (std::int64_t{row} % rows + rows) % rows;
            return ring.data() + place * run_length;
        }
    };

    /// Fields come in the same order in each run, so the strip is usually the one after the last used.
    strip& strip_of(std::uint32_t field, const noise_run& run) {
        for (std::size_t i = 0; i < strips_.size(); ++i) {
            last_ = last_ + 1 < strips_.size() ? last_ + 1 : 0;
            strip& s = strips_[last_];
            if (s.x == run.x && s.count == run.count && s.field == field && s.channel == run.channel) return s;
        }
        for (strip& s : strips_)
            // Reuses a strip whose row is not above this one: in band order, that of a finished column of runs.
            if (s.field == field && s.channel == run.channel && s.y >= run.y) {
                s.x = run.x, s.count = run.count, s.filled = false;
                return s;
            }
        last_ = strips_.size();
        strips_.push_back({field, run.channel, run.x, run.count, 0, false,
                           dynamic_array<float>((2 * taps_y_.size() - 1) * run_length)});
        return strips_.back();
    }

    /// White noise of a row, blurred along it.
    void blur_row(float* into, std::uint32_t field, const noise_run& run) const {
        const int reach = static_cast<int>(taps_x_.size()) - 1;
        draw_buffer buffer;
        dynamic_array<float> white;
        for (int x = run.x - reach; x < run.x + run.count + reach; x += run_length) {
            const int count = (std::min)(run_length, run.x + run.count + reach - x);
            const float* const draws = white_draws<Draws>(buffer, noise_, field, {x, run.y, count, run.channel});
            white.append({draws, static_cast<std::size_t>(count)});
        }
        dispatch(taps_along_row{taps_x_, white.data() + reach, 1, into, static_cast<std::size_t>(run.count)},
                 best_isa());
    }

    noise_key noise_;
    dynamic_array<float> taps_x_, taps_y_;
    dynamic_array<strip> strips_;
    std::size_t last_ = 0;
    dynamic_array<const float*> rows_;
};

/// Draws that are independent, or correlated by a length or by taps.
template <class Draws>
class field_draws {
  public:
    explicit field_draws(noise_key noise) : noise_(noise) {}
    /// Correlated if the length is not 0.
    field_draws(noise_key noise, const correlation_length& length) : field_draws(noise) {
        if (length.x > 0 || length.y > 0)
            correlate(field_taps(static_cast<double>(length.x)), field_taps(static_cast<double>(length.y)));
    }

    /// @param x, y  taps of the filters along rows and columns
    void correlate(dynamic_array<float> x, dynamic_array<float> y) {
        correlated_.emplace(noise_, std::move(x), std::move(y));
    }
    bool is_correlated() const { return correlated_.has_value(); }
    /// See filter/concept.hpp.
    int rows_above() const { return correlated_ ? correlated_->rows_above() : 0; }

    /// The draws of a run; they lie in `buffer`.
    const float* row(draw_buffer& buffer, std::uint32_t field, const noise_run& run) {
        if (!correlated_) return white_draws<Draws>(buffer, noise_, field, run);
        correlated_->row(buffer, field, run);
        return buffer;
    }

  private:
    noise_key noise_;
    std::optional<correlated_draws<Draws>> correlated_;
};
using normal_fields = field_draws<normal_draws>;

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
