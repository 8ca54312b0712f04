// The named values of one image: drawn from the seed and the image's index, or given by a line of a plan.
//
// A random number is consumed whether or not the value is given, so that giving one value does not change the others.
// manifest.csv holds the values in full precision, so that its lines are a plan that draws the same images again.
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

/// An item of a list, and its weight among the others.
struct weighted {
    std::string name;
    double weight = 1;
};

/// Draws values or takes them from a plan, and collects all of them.
class sampler {
  public:
    /// @param given  line of a plan, which must outlive the sampler; null without a plan
    sampler(const insonify::random_sequence& random, const plan_row* given) : random_(random), given_(given) {}

    /// Switches to another random sequence. @returns the previous one
    insonify::random_sequence draw_from(const insonify::random_sequence& other) {
        return std::exchange(random_, other);
    }

    double uniform(const std::string& name, double low, double high) {
        const double drawn = random_.uniform(low, high);
        return keep(name, number_or(name, drawn));
    }
    /// Uniform in the logarithm.
    double logarithmic(const std::string& name, double low, double high) {
        namespace numeric = insonify::numeric;
        const double drawn = low * numeric::exp(random_.uniform() * numeric::log(high / low));
        return keep(name, number_or(name, drawn));
    }
    /// 0 with probability `none`, otherwise uniform.
    double uniform_or_0(const std::string& name, double none, double low, double high) {
        const bool is_none = random_.uniform() < none;
        const double drawn = random_.uniform(low, high);
        return keep(name, number_or(name, is_none ? 0.0 : drawn));
    }
    /// A value computed from others, unless the plan gives it.
    double derived(const std::string& name, double value) { return keep(name, number_or(name, value)); }
    /// A uniform number that is not recorded; values are derived from it.
    double drawn(double low, double high) { return random_.uniform(low, high); }
    /// An integer in [low, high].
    int whole(const std::string& name, int low, int high) {
        const int drawn = low + static_cast<int>(random_.below(static_cast<std::uint32_t>(high - low + 1)));
        return static_cast<int>(keep(name, integer_or(name, drawn)));
    }
    /// An integer computed from other values, unless the plan gives it.
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
    /// A name from a list. Names of weight 0 are never drawn; a plan may give them.
    /// @param otherwise  replaces the drawn name unless empty
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
    /// A name from the plan, or `otherwise`.
    std::string name_of(const std::string& name, const std::string& otherwise) {
        const std::string* const text = given(name);
        values_[name] = text == nullptr ? otherwise : *text;
        return values_[name].get<std::string>();
    }
    /// Records null for a value without meaning in this image.
    void drop(const std::string& name) { values_[name] = nullptr; }

    const nlohmann::ordered_json& values() const { return values_; }
    /// The lists passed to `choice`, by name.
    const std::map<std::string, std::vector<std::string>>& choices() const { return choices_; }

    const std::string* given(const std::string& name) const { return given_ == nullptr ? nullptr : given_->find(name); }

    /// @throws plan_error that names line, column and value if the plan gives the value, else io_error
    [[noreturn]] void refuse(const std::string& name, const std::string& expected) const {
        if (given(name) != nullptr) given_->refuse(name, expected);
        throw insonify::io_error(name + " is not " + expected);
    }

    /// A number from the plan, or `otherwise`; not recorded.
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

/// The aspect in degrees, if a plan or `--aspects` gives one.
inline std::optional<double> aspect_of(const sampler& s, const view_of_target& view) {
    if (s.given("aspect_deg") != nullptr) return s.number_or("aspect_deg", 0);
    if (!view.aspect && s.given("orientation_deg") == nullptr) return std::nullopt;
    return view.aspect.value_or(0) + s.number_or("orientation_deg", 0);
}

}  // namespace generator
