# The consumers' program, with warnings of its own.
add_executable(app ../app.cpp)
set_target_properties(app PROPERTIES NO_SYSTEM_FROM_IMPORTED ON)
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  target_compile_options(app PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Werror)
endif()
