// Matchers of pictures for Catch2, version 3 or 2.13: CHECK_THAT(frame.image, in::matches(golden.is("cube"))).
//
// Include after Catch2's own header.
#pragma once

#include <insonify/testing/golden.hpp>

#if __has_include(<catch2/matchers/catch_matchers_templated.hpp>)
#include <catch2/matchers/catch_matchers_templated.hpp>
#define INSONIFY_CATCH_MATCHER Catch::Matchers::MatcherGenericBase
#else
#include <catch2/catch.hpp>
#define INSONIFY_CATCH_MATCHER Catch::Matchers::Impl::MatcherUntypedBase
#endif

#include <string>
#include <utility>

namespace insonify {
inline namespace INSONIFY_ABI {

inline namespace INSONIFY_FLAGS {

/// Catch2's form of a picture matcher.
template <class Matcher>
class catch_picture_matcher : public INSONIFY_CATCH_MATCHER {
  public:
    explicit catch_picture_matcher(Matcher matcher) : matcher_(std::move(matcher)) {}

    template <class Picture>
    bool match(const Picture& picture) const {
        message_ = matcher_.compare(picture).message;
        return message_.empty();
    }
    std::string describe() const override { return "is " + matcher_.what + (message_.empty() ? "" : ": " + message_); }

  private:
    Matcher matcher_;
    mutable std::string message_;  // Catch2 calls describe() after match()
};

/// A picture matcher, `is_picture(expected)` or `golden.is("name")`, for CHECK_THAT and REQUIRE_THAT.
template <class Compare>
auto matches(picture_matcher<Compare> matcher) {
    return catch_picture_matcher<picture_matcher<Compare>>(std::move(matcher));
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

/// Text that Catch2 prints for a picture.
template <class Pixel>
struct Catch::StringMaker<insonify::image<Pixel>> {
    static std::string convert(const insonify::image<Pixel>& picture) {
        return "a picture of " + insonify::detail::size_text(picture.width(), picture.height());
    }
};

#undef INSONIFY_CATCH_MATCHER
