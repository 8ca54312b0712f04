// The values of one image by name: drawn from the seed and the image's index, or given by a line of a plan.
//
// A draw is spent whether a value is given or not, so that giving one value leaves the others what they were. What was
// drawn is written in full precision to manifest.csv, whose lines are therefore lines of a plan that draw the same
// image again.
#pragma once

#include <insonify/core/random.hpp>
#include <insonify/insonify.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "plan_limits.hpp"
#include "plan_table.hpp"
#include "views.hpp"
#include <nlohmann/json.hpp>

namespace generator {

/// One of a list, and how often it is drawn relative to the others.
struct weighted {
    std::string name;
    double weight = 1;
};

class sampler {
  public:
    /// @param given  outlives the sampler; null: nothing is given
    sampler(const insonify::random_sequence& random, const plan_row* given) : random_(random), given_(given) {}

    /// Draws from another sequence from here on. @returns the one before
    insonify::random_sequence draw_from(const insonify::random_sequence& other) {
        return std::exchange(random_, other);
    }

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
    /// Drawn without a name, for values that follow from it.
    double drawn(double low, double high) { return random_.uniform(low, high); }
    /// A whole number in [low, high].
    int whole(const std::string& name, int low, int high) {
        const int drawn = low + static_cast<int>(random_.below(static_cast<std::uint32_t>(high - low + 1)));
        return static_cast<int>(keep(name, integer_or(name, drawn)));
    }
    /// A whole number that follows from other values, unless it is given.
    int derived_whole(const std::string& name, int value) {
        return static_cast<int>(keep(name, integer_or(name, value)));
    }
    bool chance(const std::string& name, double probability) {
        const bool drawn = random_.uniform() < probability;
        const std::string* const text = given(name);
        if (text != nullptr && *text != "true" && *text != "false") given_->refuse(name, "true or false");
        const bool value = text == nullptr ? drawn : *text == "true";
        values_[name] = value;
        return value;
    }
    std::uint32_t word(const std::string& name) {
        const std::uint32_t drawn = random_.word();
        return static_cast<std::uint32_t>(
            keep(name, given_ == nullptr ? drawn : given_->whole(name, drawn, 0, 0xFFFFFFFFu)));
    }
    /// Names of weight 0 are given alone, and never drawn.
    /// @param otherwise  a name that is not drawn but chosen elsewhere
    std::string choice(const std::string& name, const std::vector<weighted>& of, const std::string& otherwise = "") {
        double sum = 0, at = random_.uniform();
        for (const weighted& w : of) sum += w.weight;
        std::string value;
        for (const weighted& w : of) {
            if (w.weight > 0) value = w.name;
            at -= w.weight / sum;
            if (at < 0) break;
        }
        if (!otherwise.empty()) value = otherwise;
        std::vector<std::string>& names = choices_[name];
        names.clear();
        for (const weighted& w : of) names.push_back(w.name);
        if (const std::string* const text = given(name)) {
            value = *text;
            std::string list;
            for (const std::string& n : names) list += (list.empty() ? "" : ",") + n;
            if (std::find(names.begin(), names.end(), value) == names.end()) given_->refuse(name, "one of " + list);
        }
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
    /// The lists that were chosen from.
    const std::map<std::string, std::vector<std::string>>& choices() const { return choices_; }

    const std::string* given(const std::string& name) const { return given_ == nullptr ? nullptr : given_->find(name); }

    /// @throws plan_error that names line, column and value, where the value is given
    [[noreturn]] void refuse(const std::string& name, const std::string& expected) const {
        if (given(name) != nullptr) given_->refuse(name, expected);
        throw insonify::io_error(name + " is not " + expected);
    }

    /// A number that is given, or another one; neither is written.
    double number_or(const std::string& name, double otherwise) const {
        if (given_ == nullptr) return otherwise;
        const limits within = limits_of(name);
        return given_->number(name, otherwise, within.low, within.high);
    }

  private:
    std::int64_t integer_or(const std::string& name, int otherwise) const {
        const double value = number_or(name, otherwise);
        const std::int64_t whole = insonify::numeric::floor_to_int(value);
        if (static_cast<double>(whole) != value) given_->refuse(name, "a whole number");
        return whole;
    }
    template <class Number>
    Number keep(const std::string& name, Number value) {
        values_[name] = value;
        return value;
    }

    insonify::random_sequence random_;
    const plan_row* given_;
    nlohmann::ordered_json values_ = nlohmann::ordered_json::object();
    std::map<std::string, std::vector<std::string>> choices_;
};

/// The aspect that a plan or `--aspects` gives, degrees.
inline std::optional<double> aspect_of(const sampler& s, const view_of_target& view) {
    if (s.given("aspect_deg") != nullptr) return s.number_or("aspect_deg", 0);
    if (!view.aspect && s.given("orientation_deg") == nullptr) return std::nullopt;
    return view.aspect.value_or(0) + s.number_or("orientation_deg", 0);
}

}  // namespace generator
