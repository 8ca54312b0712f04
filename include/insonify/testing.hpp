// Pictures in unit tests: compared with a tolerance, or with golden files. Opt-in; testing/catch2.hpp has matchers for
// Catch2, those for GoogleTest are here.
#pragma once

#include <insonify/testing/compare.hpp>
#include <insonify/testing/golden.hpp>
