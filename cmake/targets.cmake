# One function a kind of target, so that every folder's CMakeLists.txt is a list of files and a list of friends.

# tyndall_library(name SOURCES … [DEPENDS …] [PRIVATE …])
function(tyndall_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE" ${ARGN})
  add_library(tyndall_${name} STATIC ${ARG_SOURCES})
  add_library(Tyndall::${name} ALIAS tyndall_${name})
  target_include_directories(tyndall_${name} PUBLIC ${CMAKE_SOURCE_DIR}/engine ${CMAKE_SOURCE_DIR}/shaders)
  target_link_libraries(tyndall_${name} PUBLIC ${ARG_DEPENDS} PRIVATE tyndall_warnings ${ARG_PRIVATE})
endfunction()

# tyndall_program(name SOURCES … DEPENDS …)
function(tyndall_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE tyndall_warnings ${ARG_DEPENDS})
endfunction()

# tyndall_test(name LABEL unit SOURCES … DEPENDS … [PROPERTIES …]): one executable, one CTest entry:
# its cases share a process, and so a GL context and compiled shaders.
function(tyndall_test name)
  cmake_parse_arguments(ARG "SLOW" "LABEL;TIMEOUT" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE tyndall_warnings ${ARG_DEPENDS} GTest::gtest GTest::gmock tyndall_test_support)
  target_compile_definitions(${name} PRIVATE TYNDALL_ASSERTS)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 900) # software GL compiles shaders slowly on a busy machine
  endif()
  set(labels ${ARG_LABEL})
  if(ARG_SLOW)
    list(APPEND labels slow)
  endif()
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS "${labels}" TIMEOUT ${ARG_TIMEOUT}
    ENVIRONMENT "TYNDALL_SOURCE_DIR=${CMAKE_SOURCE_DIR};TYNDALL_BIN_DIR=${CMAKE_BINARY_DIR}/bin")
endfunction()
