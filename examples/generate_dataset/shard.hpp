// A shard of a data set, for one of several machines: contiguous indices, so that shards share few folders.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

namespace generator {

/// Shard `number` of `of`, from 0; a run without shards is 0 of 1.
struct shard {
    std::uint64_t number = 0, of = 1;
    bool given = false;
};

/// Indices in [first, last).
struct index_range {
    std::uint64_t first, last;
    std::uint64_t size() const { return last - first; }
};

/// The range of a shard. Ranges are contiguous, and their sizes differ by at most one.
inline index_range range_of(std::uint64_t first, std::uint64_t count, const shard& s) {
    const std::uint64_t each = count / s.of, rest = count % s.of;
    const auto begin = [&](std::uint64_t k) { return first + k * each + (std::min)(k, rest); };
    return {begin(s.number), begin(s.number + 1)};
}

/// Parses `K/N`, or `N`, with K from the job array: SLURM_ARRAY_TASK_ID, or JOB_COMPLETION_INDEX of Kubernetes.
/// @throws std::invalid_argument whose text shows the expected form
shard parse_shard(const std::string& text);

}  // namespace generator
