# Defines the target `test_mesa`, Mesa's software renderer, if EGL and OpenGL ES are installed.
include_guard(GLOBAL)
find_library(INSONIFY_EGL EGL)
find_library(INSONIFY_GLES GLESv2)
find_path(INSONIFY_GLES_INCLUDE_DIR GLES3/gl3.h)
mark_as_advanced(INSONIFY_EGL INSONIFY_GLES INSONIFY_GLES_INCLUDE_DIR)

if(INSONIFY_EGL AND INSONIFY_GLES AND INSONIFY_GLES_INCLUDE_DIR)
  add_library(test_mesa INTERFACE)
  target_include_directories(test_mesa SYSTEM INTERFACE ${INSONIFY_GLES_INCLUDE_DIR})
  target_link_libraries(test_mesa INTERFACE ${INSONIFY_EGL} ${INSONIFY_GLES})
else()
  message(STATUS "EGL or OpenGL ES not found (Debian: libegl-dev libgles-dev libgl1-mesa-dri): pictures are not compared with llvmpipe.")
endif()
