// Poisson counts of means below 256, with neither logarithm nor second trial: the whole part of a mean has a table, its
// rest so small a count that a few sums find it, and two Poisson counts added are one.
//
// Based on: Alastair J. Walker. An Efficient Method for Generating Discrete Random Variables with General
// Distributions. ACM Transactions on Mathematical Software 3, 1977. Michael D. Vose. A Linear Algorithm for Generating
// Random Numbers with a Given Distribution. IEEE Transactions on Software Engineering 17, 1991 (how to fill the table).
#pragma once

#include <insonify/filter/detail/rejection.hpp>

#include <array>
#include <cstdint>
#include <memory>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// For each whole mean below 256 the laws of 256 counts in a row, eight standard deviations and more to either side.
///
/// A word draws from them exactly: its upper byte names a slot, and its other bits tell whether the slot's own count is
/// meant or its alias. Probabilities are rounded to multiples of 2^-32.
class poisson_tables {
  public:
    static constexpr int means = 256, slots = 256, slot_bits = 8, share_bits = 24;

    poisson_tables() : entries_(std::make_unique<std::uint32_t[]>(means * slots)) {
        for (int mean = 0; mean < means; ++mean) fill(mean, entries_.get() + mean * slots);
    }

    /// The count of a mean's first slot.
    static constexpr int first(int mean) { return mean > slots / 2 ? mean - slots / 2 : 0; }

    /// Of slot s of mean m, at slots m + s: how many words in 2^24 mean itself, then the slot of the others.
    const std::uint32_t* entries() const { return entries_.get(); }

    /// Those that everyone shares: made by who needs them first, in a millisecond.
    static const poisson_tables& shared() {
        static const poisson_tables tables;
        return tables;
    }

  private:
    using weights = std::array<std::int64_t, slots>;

    /// How many words of 2^32 mean each slot's count.
    static weights words_of(int mean) {
        const int begin = first(mean), mode = mean - begin;
        // Each probability is the one before it times mean / count; the largest is 1 until the sum is known.
        std::array<double, slots> p{};
        p[static_cast<std::size_t>(mode)] = 1;
        for (int i = mode; i > 0; --i)
            p[static_cast<std::size_t>(i - 1)] = p[static_cast<std::size_t>(i)] * (begin + i) / mean;
        for (int i = mode + 1; i < slots; ++i)
            p[static_cast<std::size_t>(i)] = p[static_cast<std::size_t>(i - 1)] * mean / (begin + i);
        double sum = 0;
        for (const double value : p) sum += value;
        weights words{};
        std::int64_t left = std::int64_t{1} << 32;
        for (std::size_t i = 0; i < p.size(); ++i) {
            words[i] = static_cast<std::int64_t>(p[i] / sum * 0x1p32 + 0.5);
            left -= words[i];
        }
        words[static_cast<std::size_t>(mode)] += left;
        return words;
    }

    static void fill(int mean, std::uint32_t* entries) {
        constexpr std::int64_t room = std::int64_t{1} << share_bits;
        weights words = words_of(mean);
        // Slots with words to spare fill those that lack some, and may come to lack some themselves.
        std::array<int, slots> lacking, rich;
        int lacking_count = 0, rich_count = 0;
        for (int i = 0; i < slots; ++i) {
            if (words[static_cast<std::size_t>(i)] < room)
                lacking[static_cast<std::size_t>(lacking_count++)] = i;
            else
                rich[static_cast<std::size_t>(rich_count++)] = i;
        }
        while (lacking_count > 0) {
            const int poor = lacking[static_cast<std::size_t>(--lacking_count)];
            const int giver = rich[static_cast<std::size_t>(rich_count - 1)];
            const std::int64_t own = words[static_cast<std::size_t>(poor)];
            std::int64_t& others = words[static_cast<std::size_t>(giver)];
            entries[poor] = static_cast<std::uint32_t>(own << slot_bits | giver);
            others -= room - own;
            if (others < room) {
                --rich_count;
                lacking[static_cast<std::size_t>(lacking_count++)] = giver;
            }
        }
        // What is full has no need of others.
        while (rich_count > 0) {
            const int full = rich[static_cast<std::size_t>(--rich_count)];
            entries[full] = static_cast<std::uint32_t>(full);
        }
    }

    std::unique_ptr<std::uint32_t[]> entries_;
};

/// How many of a Poisson law's events a uniform number means, for means in [0, 1): as many as there are k whose
/// probability of more than k it doesn't exceed. No probability is off by more than 2e-7.
template <int N>
INSONIFY_INLINE void rare_count(lanes<std::int32_t, N>& into, const lanes<float, N>& mean,
                                const lanes<float, N>& uniform) {
    using floats = lanes<float, N>;
    using ints = lanes<std::int32_t, N>;
    const floats m = mean;
    // 1 - exp(-m), without the difference.
    floats more = 1.0f - m * (1 / 10.0f);
    unroll<8>([&](int i) INSONIFY_INLINE_LAMBDA { more = 1.0f - m * (1 / static_cast<float>(9 - i)) * more; });
    more = m * more;
    const floats none = 1.0f - more;
    floats power = m;  // m^k / k!
    into = ints{};
    const auto step = [&](float k) INSONIFY_INLINE_LAMBDA {
        const ints reached = ints(uniform <= more);
        into = reached != 0 ? into + 1 : into;
        more = more - none * power;
        power = power * (m * (1 / (k + 1)));
        more = more < power ? more : power;  // as it is, so that what rounding leaves is no probability
    };
    // More than four are so rare that none is easy to guess.
    unroll<4>([&](int i) INSONIFY_INLINE_LAMBDA { step(static_cast<float>(i + 1)); });
    for (float k = 5; any(ints(uniform <= more)); ++k) step(k);
}

/// Draws the counts of a run's pixels whose means are below 256. Of the others it makes a list, and their means.
struct poisson_table_kernel {
    static constexpr int widest = 16;

    const std::uint32_t* tables;
    const float* from;
    const float* word;  // its bits
    const float* uniform;
    float* to;
    int count;
    float photons;
    pixel_list* large;

    template <int N>
    INSONIFY_INLINE void run() const {
        const poisson_table_kernel own = *this;  // which nothing that is stored can change
        int listed = 0, i = 0;
        for (; i + N <= own.count; i += N) own.at<N>(i, listed);
        for (; i < own.count; ++i) own.at<1>(i, listed);
        own.large->count = listed;
    }

  private:
    template <int N>
    INSONIFY_INLINE void at(int i, int& listed) const {
        using floats = lanes<float, N>;
        using ints = lanes<std::int32_t, N>;
        floats pixel, drawn;
        lanes<std::uint32_t, N> bits;
        load(pixel, from + i), load(drawn, uniform + i), load(bits, word + i);
        floats mean = pixel;
        clip_lanes<N>(mean);
        mean = mean * photons;
        const ints is_small = ints(mean < static_cast<float>(poisson_tables::means));
        const floats table_mean = is_small != 0 ? mean : floats{};
        ints whole, table_count, rare;
        floats whole_mean, result;
        convert(whole, table_mean);
        convert(whole_mean, whole);
        drawn_slot<N>(table_count, whole, bits);
        rare_count<N>(rare, table_mean - whole_mean, drawn);
        convert(result, ints(table_count + rare));
        result = result / photons;
        clip_lanes<N>(result);
        store(to + i, is_small != 0 ? result : mean);
        const ints is_large = ints(mean >= static_cast<float>(poisson_tables::means));
        if (any(is_large)) {
            for (int k = 0; k < N; ++k) add_if((lane(is_large, k) & 1) != 0, i + k, large->places, listed);
        }
    }

    /// The count that a word means in the table of a whole mean.
    template <int N>
    INSONIFY_INLINE void drawn_slot(lanes<std::int32_t, N>& into, const lanes<std::int32_t, N>& mean,
                                    const lanes<std::uint32_t, N>& bits) const {
        using ints = lanes<std::int32_t, N>;
        constexpr std::int32_t slot_mask = poisson_tables::slots - 1,
                               share_mask = (1 << poisson_tables::share_bits) - 1;
        const ints own = ints(bits >> poisson_tables::share_bits);
        const ints index = (mean << poisson_tables::slot_bits) | own;
        lanes<std::uint32_t, N> entry;
        gather<N>(entry, [&](int k) { return tables[lane(index, k)]; });
        const ints share = ints(entry >> poisson_tables::slot_bits), place = ints(bits) & share_mask;
        const ints beyond = mean - poisson_tables::slots / 2;
        into = (place < share ? own : ints(entry) & slot_mask) + (beyond > 0 ? beyond : ints{});
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
