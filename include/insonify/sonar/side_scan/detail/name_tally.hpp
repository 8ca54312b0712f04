// Which of several names has most of a bin: lengths or powers are summed by bin and name.
#pragma once

#include <insonify/core/numeric.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

class name_tally {
  public:
    explicit name_tally(std::size_t bins) : heads_(bins, none) {}

    bool empty() const { return entries_.empty(); }
    void clear() {
        if (empty()) return;
        heads_.assign(heads_.size(), none);
        entries_.clear();
    }
    void add(std::size_t bin, std::uint16_t name, float amount) {
        std::uint32_t* at = &heads_[bin];
        while (*at != none && entries_[*at].name != name) at = &entries_[*at].next;
        if (*at != none) {
            entries_[*at].amount += amount;
            return;
        }
        *at = static_cast<std::uint32_t>(entries_.size());
        entries_.push_back({amount, none, name});
    }
    struct share {
        std::uint16_t name;
        float amount;
    };
    /// The name that has most; of equal ones the first that was added. `otherwise` where nothing was.
    share largest(std::size_t bin, std::uint16_t otherwise) const {
        share best{otherwise, 0};
        for (std::uint32_t i = heads_[bin]; i != none; i = entries_[i].next)
            if (entries_[i].amount > best.amount) best = {entries_[i].name, entries_[i].amount};
        return best;
    }

  private:
    static constexpr std::uint32_t none = 0xFFFFFFFFu;
    struct entry {
        float amount;
        std::uint32_t next;
        std::uint16_t name;
    };
    std::vector<std::uint32_t> heads_;
    std::vector<entry> entries_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
