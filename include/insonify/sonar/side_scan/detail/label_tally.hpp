// Sums of length or power by range bin and label; the largest sum decides a bin's label.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>

#include <cstddef>
#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A linked list of labels per bin, all in one vector.
class label_tally {
  public:
    explicit label_tally(std::size_t bins) : heads_(bins, none) {}

    bool empty() const { return entries_.empty(); }
    void clear() {
        if (empty()) return;
        heads_.assign(heads_.size(), none);
        entries_.clear();
    }
    void add(std::size_t bin, std::uint16_t label, float amount) {
        std::uint32_t* at = &heads_[bin];
        while (*at != none && entries_[*at].label != label) at = &entries_[*at].next;
        if (*at != none) {
            entries_[*at].amount += amount;
            return;
        }
        *at = static_cast<std::uint32_t>(entries_.size());
        entries_.push_back({amount, none, label});
    }
    struct sum {
        std::uint16_t label;
        float amount;
    };
    /// The label with the largest sum, of equal ones the first that was added; `fallback` for an empty bin.
    sum largest(std::size_t bin, std::uint16_t fallback) const {
        sum best{fallback, 0};
        for (std::uint32_t i = heads_[bin]; i != none; i = entries_[i].next)
            if (entries_[i].amount > best.amount) best = {entries_[i].label, entries_[i].amount};
        return best;
    }

  private:
    static constexpr std::uint32_t none = 0xFFFFFFFFu;
    struct entry {
        float amount;
        std::uint32_t next;
        std::uint16_t label;
    };
    dynamic_array<std::uint32_t> heads_;
    dynamic_array<entry> entries_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
