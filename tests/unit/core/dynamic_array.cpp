// Growing arrays against std::vector, for elements that are copied as bytes and for others.
#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/random.hpp>

#include <cstdint>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../../catch.hpp"

namespace in = insonify;
using in::detail::dynamic_array;

namespace {

std::uint32_t element(std::uint32_t value, std::uint32_t) {
    return value;
}
std::string element(std::uint32_t value, const std::string&) {
    return std::to_string(value) + (value % 2 == 0 ? "" : " long enough not to be stored in place");
}

}  // namespace

TEMPLATE_TEST_CASE("dynamic_array holds what std::vector holds after any sequence of changes", "", std::uint32_t,
                   std::string) {
    in::random_sequence random(1, 0, 0);
    dynamic_array<TestType> array;
    std::vector<TestType> vector;
    for (int step = 0; step < 2000; ++step) {
        const std::size_t count = random.word() % 40;
        const TestType value = element(random.word(), TestType());
        switch (random.word() % 8) {
            case 0:
                array.resize(count);
                vector.resize(count);
                break;
            case 1:
                array.assign(count, value);
                vector.assign(count, value);
                break;
            case 2: {
                const std::vector<TestType> more(count, value);
                array.append(more);
                vector.insert(vector.end(), more.begin(), more.end());
                break;
            }
            case 3: array.reserve(2 * count); break;
            case 4:
                if (vector.empty()) break;
                array.push_back(array.front());  // an element of its own, also where the array grows
                vector.push_back(TestType(vector.front()));
                break;
            case 5:
                if (vector.empty()) break;
                array.pop_back();
                vector.pop_back();
                break;
            case 6: array = dynamic_array<TestType>(array); break;
            default: array.push_back(value); vector.push_back(value);
        }
        if (vector.size() > 500) {
            array.clear();
            vector.clear();
        }
        REQUIRE(std::vector<TestType>(array.begin(), array.end()) == vector);
    }
}

TEST_CASE("Copies are independent, and a moved array leaves an empty one") {
    dynamic_array<std::string> array{"a", "b"};
    const dynamic_array<std::string> copy = array;
    array[0] = "c";
    const dynamic_array<std::string> moved = std::move(array);
    CHECK(copy.front() == "a");
    CHECK(moved.front() == "c");
    CHECK(moved.back() == "b");
    CHECK(array.empty());
}

TEST_CASE("Over-aligned elements are aligned, also after the array has grown") {
    struct alignas(64) wide {
        int value;
    };
    dynamic_array<wide> array;
    for (int i = 0; i < 100; ++i) {
        array.push_back({i});
        REQUIRE(reinterpret_cast<std::uintptr_t>(array.data()) % 64 == 0);
    }
}

TEST_CASE("Elements of growing arrays are destroyed once") {
    static int alive;
    struct counted {
        counted() { ++alive; }
        counted(const counted&) { ++alive; }
        counted(counted&&) noexcept { ++alive; }
        counted& operator=(const counted&) = default;
        ~counted() { --alive; }
    };
    alive = 0;
    {
        dynamic_array<counted> some(5), others;
        for (int i = 0; i < 100; ++i) others.push_back(counted());
        CHECK(alive == 105);
        some.resize(3);
        CHECK(alive == 103);
        some = others;
        CHECK(alive == 200);
        others.clear();
        CHECK(alive == 100);
    }
    CHECK(alive == 0);
}

TEST_CASE("A copy that fails leaves no element behind") {
    static int alive, copies;
    struct fragile {
        fragile() { ++alive; }
        fragile(const fragile&) {
            if (++copies == 3) throw std::runtime_error("copied thrice");
            ++alive;
        }
        fragile(fragile&&) noexcept { ++alive; }
        ~fragile() { --alive; }
    };
    alive = copies = 0;
    {
        in::detail::dynamic_array<fragile> source;
        source.resize(5);
        CHECK_THROWS_AS(in::detail::dynamic_array<fragile>(source), std::runtime_error);
        CHECK(alive == 5);
    }
    CHECK(alive == 0);
}

#if !defined(INSONIFY_SANITIZED)  // sanitizers end a program that asks for so much
TEST_CASE("resize() and reserve() beyond the address space throw std::bad_alloc and keep the elements") {
    dynamic_array<double> array(3, 1.5);
    CHECK_THROWS_AS(array.resize(SIZE_MAX), std::bad_alloc);
    CHECK_THROWS_AS(array.reserve(SIZE_MAX / 8 + 2), std::bad_alloc);
    CHECK(array.size() == 3);
    CHECK(array[2] == 1.5);
}
#endif
