# Runs `program` and compares its output with the file `golden`.
execute_process(COMMAND ${program} OUTPUT_VARIABLE printed ERROR_VARIABLE complaint RESULT_VARIABLE result)
file(READ ${golden} expected)
if(NOT result EQUAL 0 OR NOT printed STREQUAL expected)
  message(FATAL_ERROR "${complaint}expected\n${expected}\nbut ${program} (exit ${result}) printed\n${printed}")
endif()
