#include "shard.hpp"

#include <cstdlib>
#include <stdexcept>
#include <tuple>

#include "../common/parse.hpp"

namespace generator {

namespace {

constexpr const char* usage = "write K/N with K from 0 to N-1, or N alone in a job array of tasks 0 to N-1";

std::uint64_t number(const std::string& text, const std::string& where) {
    std::uint64_t value = 0;
    if (!examples::parse(text, value))
        throw std::invalid_argument(where + "'" + text + "' is not a whole number; " + usage);
    return value;
}

/// Name and value of the environment variable with the index of this job-array task.
std::pair<std::string, std::string> job_array_index() {
    std::pair<std::string, std::string> found;
    for (const char* const name : {"SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX"}) {
        const char* const value = std::getenv(name);
        if (value == nullptr || *value == '\0') continue;
        if (!found.first.empty() && found.second != value)
            throw std::invalid_argument(found.first + " is " + found.second + " and " + name + " is " + value +
                                        "; write K/N to choose one");
        found = {name, value};
    }
    return found;
}

}  // namespace

shard parse_shard(const std::string& text) {
    const std::size_t slash = text.find('/');
    shard s{.given = true};
    s.of = number(text.substr(slash == std::string::npos ? 0 : slash + 1), "N of '" + text + "': ");
    if (s.of < 1 || s.of > 1'000'000)
        throw std::invalid_argument("'" + text + "': N is not within 1 and 1000000; " + usage);
    std::string where = "K of '" + text + "'", k;
    if (slash != std::string::npos) {
        k = text.substr(0, slash);
    } else {
        std::tie(where, k) = job_array_index();
        if (where.empty())
            throw std::invalid_argument("'" + text +
                                        "' has no K, and neither SLURM_ARRAY_TASK_ID nor JOB_COMPLETION_INDEX is "
                                        "set; " +
                                        usage);
    }
    s.number = number(k, where + ": ");
    if (s.number >= s.of)
        throw std::invalid_argument(where + " is " + k + ", but " + std::to_string(s.of) + " shards count from 0 to " +
                                    std::to_string(s.of - 1) + "; " + usage);
    return s;
}

}  // namespace generator
