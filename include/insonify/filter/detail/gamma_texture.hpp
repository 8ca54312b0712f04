// Correlated gamma variates of mean 1: quantiles of the gamma distribution at correlated normal variates, tabulated.
//
// Based on: Mircea Grigoriu. Applied Non-Gaussian Processes. 1995 (translation processes: a memoryless function of a
// Gaussian field has any distribution, and a correlation that follows from the field's).
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/numeric.hpp>

#include <algorithm>
#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

class gamma_texture {
  public:
    /// @param shape  0.01 to 1e6; the variance is 1 / shape
    explicit gamma_texture(double shape) : values_(knots) {
        tabulate(shape);
        expand(shape);
    }

    /// The gamma quantile at the probability Phi(z).
    float operator()(float z) const {
        const float place = (std::min)((std::max)(z + static_cast<float>(reach), 0.0f) * static_cast<float>(1 / step),
                                       static_cast<float>(knots - 2));
        const auto knot = static_cast<std::size_t>(place);
        const float t = place - static_cast<float>(knot);
        return values_[knot] + t * (values_[knot + 1] - values_[knot]);
    }

    /// Correlation of two gamma variates whose normal variates have the correlation r, 0 to 1.
    double correlation(double r) const {
        double sum = 0;
        for (std::size_t k = terms; k-- > 0;) sum = (sum + powers_[k]) * r;
        return sum;
    }

  private:
    static constexpr double reach = 7, step = 0x1p-8;  ///< of the table in z
    static constexpr std::size_t knots = 2 * 7 * 256 + 2, terms = 64, intervals = 8192;

    static double normal_density(double z) { return 0.39894228040143268 * numeric::exp(-0.5 * z * z); }

    /// Integrates the density of y = ln t, exp(shape (1 + y - e^y)), and reads it off at normal probabilities.
    void tabulate(double shape) {
        // Beyond the interval the density is below e^-40 of its peak, or t below e^-60.
        const double spread = numeric::square_root(160 / shape) + 60 / shape;
        const double low = -(std::min)(spread, 60.0), high = numeric::log(1 + spread), dy = (high - low) / intervals;
        const auto density = [&](double y) { return numeric::exp(shape * (1 + y - numeric::exp(y))); };
        dynamic_array<double> below{density(low) / shape};  // the tail to the left is exponential
        double last = density(low);
        for (std::size_t i = 1; i <= intervals; ++i) {
            const double next = density(low + static_cast<double>(i) * dy);
            below.push_back(below.back() + 0.5 * dy * (last + next));
            last = next;
        }
        double probability = 1.2798e-12;  // Phi(-7)
        std::size_t i = 0;
        for (std::size_t k = 0; k < knots; ++k) {
            const double z = static_cast<double>(k) * step - reach;
            if (k > 0) probability += 0.5 * step * (normal_density(z - step) + normal_density(z));
            const double wanted = probability * below.back();
            while (i + 1 < intervals && below[i + 1] < wanted) ++i;
            const double t = (std::min)((std::max)((wanted - below[i]) / (below[i + 1] - below[i]), 0.0), 1.0);
            values_[k] = static_cast<float>(numeric::exp(low + (static_cast<double>(i) + t) * dy));
        }
    }

    /// Powers of the terms of the Hermite series; the variance that they leave is added to the last one.
    void expand(double shape) {
        std::array<double, terms> coefficient{};
        for (std::size_t knot = 0; knot < knots; ++knot) {
            const double z = static_cast<double>(knot) * step - reach;
            double before = 0, now = normal_density(z) * step;  // times H_k / sqrt(k!)
            for (std::size_t k = 0; k < terms; ++k) {
                const auto order = static_cast<double>(k);
                const double next = (z * now - numeric::square_root(order) * before) / numeric::square_root(order + 1);
                before = now;
                now = next;
                coefficient[k] += now * static_cast<double>(values_[knot]);
            }
        }
        double left = 1;
        for (std::size_t k = 0; k < terms; ++k) {
            powers_[k] = coefficient[k] * coefficient[k] * shape;
            left -= powers_[k];
        }
        powers_[terms - 1] += left;
    }

    dynamic_array<float> values_;         ///< at z = -7, -7 + step, ...
    std::array<double, terms> powers_{};  ///< of r, r^2, ...; their sum is 1
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
