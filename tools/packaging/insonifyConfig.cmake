# CMake package: find_package(insonify) defines the targets insonify::insonify and insonify::compiled.
include(${CMAKE_CURRENT_LIST_DIR}/find_glm.cmake)
if(TARGET insonify::glm)
  include(${CMAKE_CURRENT_LIST_DIR}/insonifyTargets.cmake)
  include(${CMAKE_CURRENT_LIST_DIR}/compiled.cmake)
else()
  set(insonify_FOUND FALSE)
  string(CONCAT insonify_NOT_FOUND_MESSAGE
         "the GLM headers are missing: install libglm-dev (Debian, Ubuntu), glm-devel (Fedora) or glm (Homebrew), "
         "or pass -DINSONIFY_GLM_INCLUDE_DIR=<folder that holds glm/>")
endif()
