# Defines the target `test_embree`, Embree 4 or 3, if it is installed.
include_guard(GLOBAL)
find_path(INSONIFY_EMBREE_INCLUDE_DIR NAMES embree4/rtcore.h embree3/rtcore.h)
if(EXISTS ${INSONIFY_EMBREE_INCLUDE_DIR}/embree4/rtcore.h)  # the one that tests/embree.hpp includes
  find_library(INSONIFY_EMBREE embree4)
else()
  find_library(INSONIFY_EMBREE embree3)
endif()
mark_as_advanced(INSONIFY_EMBREE INSONIFY_EMBREE_INCLUDE_DIR)

if(INSONIFY_EMBREE AND INSONIFY_EMBREE_INCLUDE_DIR)
  add_library(test_embree INTERFACE)
  target_include_directories(test_embree SYSTEM INTERFACE ${INSONIFY_EMBREE_INCLUDE_DIR})
  target_link_libraries(test_embree INTERFACE ${INSONIFY_EMBREE})
else()
  message(STATUS "Embree not found (Debian: libembree-dev): exact shadows are not compared with it.")
endif()
