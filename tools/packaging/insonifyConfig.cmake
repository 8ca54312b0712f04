# The installed package: find_package(insonify) gives the target insonify::insonify.
include(${CMAKE_CURRENT_LIST_DIR}/find_glm.cmake)
if(TARGET insonify::glm)
  include(${CMAKE_CURRENT_LIST_DIR}/insonifyTargets.cmake)
else()
  set(insonify_FOUND FALSE)
  set(insonify_NOT_FOUND_MESSAGE "the GLM headers are missing")
endif()
