# Defines the target insonify::compiled, the compiled form: a static library, built when a target links it and optimized in
# every build type. Included by the build and by the installed package.
get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
if(TARGET insonify_compiled OR NOT CXX IN_LIST languages)
  return()
endif()

file(CONFIGURE OUTPUT insonify_compiled.cpp CONTENT "#define INSONIFY_IMPLEMENTATION\n#include <insonify/insonify.hpp>\n" @ONLY)
add_library(insonify_compiled STATIC EXCLUDE_FROM_ALL ${CMAKE_CURRENT_BINARY_DIR}/insonify_compiled.cpp)
add_library(insonify::compiled ALIAS insonify_compiled)
target_link_libraries(insonify_compiled PUBLIC insonify::insonify)
# It has no C++ modules: CMake 3.28 and newer would scan it for imports, with a tool that not every compiler comes with.
set_target_properties(insonify_compiled PROPERTIES CXX_SCAN_FOR_MODULES OFF)
target_compile_definitions(insonify_compiled INTERFACE INSONIFY_COMPILED)
# MSVC refuses /O2 beside the run-time checks of its Debug builds. With -g, g++ would spend a quarter of its time on
# where optimized code keeps each variable; lines and types stay.
target_compile_options(insonify_compiled PRIVATE
  $<IF:$<CXX_COMPILER_ID:MSVC>,$<$<NOT:$<CONFIG:Debug>>:/O2>,-O2>
  $<$<CXX_COMPILER_ID:GNU>:-fno-var-tracking>)
