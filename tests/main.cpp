// The entry point of the unit tests. Catch2 v3 brings its own main; v2 needs this one translation unit.
#if !__has_include(<catch2/catch_test_macros.hpp>)
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
#endif
