// Compares pictures in unit tests, with a tolerance or with golden files. Opt-in. Matchers for GoogleTest are included;
// those for Catch2 are in testing/catch2.hpp.
#pragma once

#include <insonify/testing/compare.hpp>
#include <insonify/testing/golden.hpp>
