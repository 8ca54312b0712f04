# Defines the target insonify::glm, from GLM's CMake package if installed, else from its headers. Included by the build and
# by the installed package, which report an error if the target is missing.
if(TARGET insonify::glm)
  return()
endif()

find_package(glm CONFIG QUIET)
find_path(INSONIFY_GLM_INCLUDE_DIR glm/vec3.hpp DOC "The folder that holds glm/, where GLM comes without its package")
mark_as_advanced(INSONIFY_GLM_INCLUDE_DIR)

if(TARGET glm::glm-header-only OR TARGET glm::glm OR INSONIFY_GLM_INCLUDE_DIR)
  add_library(insonify::glm INTERFACE IMPORTED)
  if(TARGET glm::glm-header-only)
    target_link_libraries(insonify::glm INTERFACE glm::glm-header-only)
  elseif(TARGET glm::glm)
    target_link_libraries(insonify::glm INTERFACE glm::glm)
  else()
    target_include_directories(insonify::glm INTERFACE ${INSONIFY_GLM_INCLUDE_DIR})
  endif()
endif()
