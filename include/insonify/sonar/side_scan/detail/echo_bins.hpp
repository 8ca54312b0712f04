// The range bins of one ping: power, lengths of lit and dark seabed, and the label with the largest sum in each bin.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/side_scan/detail/label_tally.hpp>

#include <algorithm>
#include <cstdint>
#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Power and contents of a range bin; lengths are in bins.
struct echo_bin {
    float bottom = 0, target = 0;  ///< power
    float lit = 0;                 ///< length of seabed
    float dark_by_seabed = 0, dark_by_target = 0;
    float of_seabed = 0;  ///< length of the first type in the bin; a label_tally has the others
    // The labels with the largest sums in the bin.
    std::uint16_t instance = labels::no_instance, caster = labels::by_seabed;
    std::uint8_t seabed = labels::no_seabed;
};

/// The bins, and the sums of the labels that are not the first of their bin.
class echo_bins {
  public:
    explicit echo_bins(std::size_t count) : bins_(count), echoing_(count), casting_(count), types_(count) {}

    void clear() { std::fill(bins_.begin(), bins_.end(), echo_bin{}); }
    std::size_t size() const { return bins_.size(); }
    echo_bin& operator[](std::size_t bin) { return bins_[bin]; }
    std::span<const echo_bin> all() const { return bins_; }

    /// Adds the echo of a target to the label of a bin.
    void add_instance(std::size_t bin, std::uint16_t instance, float power) { echoing_.add(bin, instance, power); }
    /// Adds a piece of seabed to the labels of a bin.
    /// @param caster  of its shadow, or no_shadow
    void add_seabed(std::size_t number, std::uint8_t type, std::uint16_t caster, float length) {
        echo_bin& bin = bins_[number];
        if (caster == labels::no_shadow)
            bin.lit += length;
        else if (caster == labels::by_seabed)
            bin.dark_by_seabed += length;
        else
            bin.dark_by_target += length, casting_.add(number, caster, length);
        if (bin.seabed == labels::no_seabed) bin.seabed = type;
        if (bin.seabed == type)
            bin.of_seabed += length;
        else
            types_.add(number, type, length);
    }

    /// Sets the labels with the largest sums in each bin, and clears the sums.
    void label(bool has_targets) {
        if (!types_.empty())
            for (std::size_t b = 0; b < bins_.size(); ++b) {
                const auto [type, length] = types_.largest(b, labels::no_seabed);
                if (length > bins_[b].of_seabed) bins_[b].seabed = static_cast<std::uint8_t>(type);
            }
        if (has_targets)
            for (std::size_t b = 0; b < bins_.size(); ++b) {
                echo_bin& bin = bins_[b];
                bin.instance = echoing_.largest(b, labels::no_instance).label;
                const auto [caster, length] = casting_.largest(b, labels::by_seabed);
                bin.caster = length >= bin.dark_by_seabed ? caster : labels::by_seabed;
            }
        echoing_.clear(), casting_.clear(), types_.clear();
    }

  private:
    dynamic_array<echo_bin> bins_;
    label_tally echoing_, casting_, types_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
