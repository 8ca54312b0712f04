// The values of one image by name: drawn from the seed and the image's index, or given by a row of a plan.
//
// A draw is spent whether a value is given or not, so that giving one value leaves the others what they were. What was
// drawn is written in full precision to manifest.csv, whose rows are therefore rows of a plan that draw the same image
// again.
#pragma once

#include <insonify/core/random.hpp>
#include <insonify/insonify.hpp>

#include <charconv>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace generator {

/// Cells by the names of their columns; an empty cell gives nothing.
using plan_row = std::map<std::string, std::string>;

/// One of a list, and how often it is drawn relative to the others.
struct weighted {
    std::string name;
    double weight = 1;
};

class sampler {
  public:
    /// @param attempt  which of several draws of the same image
    /// @param given    outlives the sampler; null: nothing is given
    sampler(std::uint64_t seed, std::uint64_t index, std::uint32_t attempt, const plan_row* given)
        : random_(seed, 0x736F6E00u + attempt, index), given_(given) {}

    double uniform(const std::string& name, double low, double high) {
        const double drawn = random_.uniform(low, high);
        return keep(name, number_or(name, drawn));
    }
    /// As many between 1 and 2 as between 2 and 4.
    double logarithmic(const std::string& name, double low, double high) {
        namespace numeric = insonify::numeric;
        const double drawn = low * numeric::exp(random_.uniform() * numeric::log(high / low));
        return keep(name, number_or(name, drawn));
    }
    /// 0 with a probability, otherwise as `uniform`.
    double uniform_or_0(const std::string& name, double none, double low, double high) {
        const bool is_none = random_.uniform() < none;
        const double drawn = random_.uniform(low, high);
        return keep(name, number_or(name, is_none ? 0.0 : drawn));
    }
    /// What follows from other values, unless it is given.
    double derived(const std::string& name, double value) { return keep(name, number_or(name, value)); }
    /// A whole number in [low, high].
    int whole(const std::string& name, int low, int high) {
        const int drawn = low + static_cast<int>(random_.below(static_cast<std::uint32_t>(high - low + 1)));
        const auto value = static_cast<int>(number_or(name, drawn));
        values_[name] = value;
        return value;
    }
    bool chance(const std::string& name, double probability) {
        const bool drawn = random_.uniform() < probability;
        const std::string* const text = given(name);
        if (text != nullptr && *text != "true" && *text != "false")
            throw insonify::io_error("--plan: column " + name + " has '" + *text + "', expected true or false");
        const bool value = text == nullptr ? drawn : *text == "true";
        values_[name] = value;
        return value;
    }
    std::uint32_t word(const std::string& name) {
        const std::uint32_t drawn = random_.word();
        const double value = number_or(name, drawn);
        if (!(value >= 0 && value <= 4294967295.0))
            throw insonify::io_error("--plan: column " + name + " expects a whole number below 2^32");
        values_[name] = static_cast<std::uint32_t>(value);
        return static_cast<std::uint32_t>(value);
    }
    std::string choice(const std::string& name, const std::vector<weighted>& of) {
        double sum = 0, at = random_.uniform();
        for (const weighted& w : of) sum += w.weight;
        std::string drawn = of.back().name;
        for (const weighted& w : of) {
            at -= w.weight / sum;
            if (at < 0) {
                drawn = w.name;
                break;
            }
        }
        const std::string* const text = given(name);
        const std::string value = text == nullptr ? drawn : *text;
        values_[name] = value;
        return value;
    }
    /// A name that is given, or one that follows from elsewhere.
    std::string name_of(const std::string& name, const std::string& otherwise) {
        const std::string* const text = given(name);
        values_[name] = text == nullptr ? otherwise : *text;
        return values_[name].get<std::string>();
    }
    /// Writes nothing for a value that has no meaning in this image.
    void drop(const std::string& name) { values_[name] = nullptr; }

    const nlohmann::ordered_json& values() const { return values_; }

  private:
    const std::string* given(const std::string& name) const {
        if (given_ == nullptr) return nullptr;
        const auto found = given_->find(name);
        return found == given_->end() || found->second.empty() ? nullptr : &found->second;
    }
    double number_or(const std::string& name, double otherwise) const {
        const std::string* const text = given(name);
        if (text == nullptr) return otherwise;
        double value = 0;
        const auto [end, status] = std::from_chars(text->data(), text->data() + text->size(), value);
        if (status != std::errc{} || end != text->data() + text->size() || !insonify::numeric::is_finite(value))
            throw insonify::io_error("--plan: column " + name + " has '" + *text + "', expected a number");
        return value;
    }
    double keep(const std::string& name, double value) {
        values_[name] = value;
        return value;
    }

    insonify::random_sequence random_;
    const plan_row* given_;
    nlohmann::ordered_json values_ = nlohmann::ordered_json::object();
};

}  // namespace generator
