# One function a kind of target, so that every folder's CMakeLists.txt is a list of files and a list of friends.
#
# A target sees the headers of what it links and no others: each library has an include folder of its own in the build tree, with links to its
# public headers (HEADERS) and, for itself and for tests that say INTERNALS, one with links to the rest. cmake/rooms.cmake says who may link whom.

include(rooms)

# Makes folder/prefix/*.h links to `headers` (absolute paths), and nothing else there.
function(tyndall_link_headers folder prefix)
  set(wanted "")
  foreach(header ${ARGN})
    get_filename_component(name ${header} NAME)
    list(APPEND wanted ${folder}/${prefix}/${name})
  endforeach()
  file(GLOB present ${folder}/${prefix}/*.h)
  foreach(link ${present})
    if(NOT link IN_LIST wanted AND IS_SYMLINK ${link})
      file(REMOVE ${link})
    endif()
  endforeach()
  file(MAKE_DIRECTORY ${folder}/${prefix})
  foreach(header ${ARGN})
    get_filename_component(name ${header} NAME)
    if(NOT EXISTS ${folder}/${prefix}/${name})
      file(CREATE_LINK ${header} ${folder}/${prefix}/${name} SYMBOLIC)
    endif()
  endforeach()
endfunction()

# tyndall_library(name HEADERS public.h … SOURCES … [DEPENDS …] [PRIVATE …]): a room of the engine, in the folder of that name.
function(tyndall_library name)
  cmake_parse_arguments(ARG "" "" "HEADERS;SOURCES;DEPENDS;PRIVATE" ${ARGN})
  add_library(tyndall_${name} STATIC ${ARG_SOURCES})
  add_library(Tyndall::${name} ALIAS tyndall_${name})
  file(RELATIVE_PATH prefix ${CMAKE_SOURCE_DIR}/engine ${CMAKE_CURRENT_SOURCE_DIR})
  if(prefix MATCHES "^\\.\\.")
    file(RELATIVE_PATH prefix ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  endif()
  file(GLOB private CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.h)
  list(TRANSFORM ARG_HEADERS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE public)
  if(public)
    list(REMOVE_ITEM private ${public})
  endif()
  set(folder ${CMAKE_BINARY_DIR}/include/${name})
  tyndall_link_headers(${folder} ${prefix} ${public})
  tyndall_link_headers(${folder}.private ${prefix} ${private})
  target_include_directories(tyndall_${name} PUBLIC ${folder} PRIVATE ${folder}.private)
  target_link_libraries(tyndall_${name} PUBLIC ${ARG_DEPENDS} PRIVATE tyndall_warnings ${ARG_PRIVATE})
  tyndall_check_arrows(${name} ${ARG_DEPENDS} ${ARG_PRIVATE})
endfunction()

# tyndall_program(name SOURCES … DEPENDS …)
function(tyndall_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE tyndall_warnings ${ARG_DEPENDS})
  tyndall_check_arrows(${name} ${ARG_DEPENDS})
endfunction()

# Lets a target include private headers of rooms that it links. For tests.
function(tyndall_see_internals target)
  foreach(room ${ARGN})
    target_include_directories(${target} PRIVATE ${CMAKE_BINARY_DIR}/include/${room}.private)
  endforeach()
endfunction()

# tyndall_test(name LABEL unit SOURCES … DEPENDS … [INTERNALS room …]): one executable, one CTest entry:
# its cases share a process, and so a GL context and compiled shaders.
function(tyndall_test name)
  cmake_parse_arguments(ARG "SLOW" "LABEL;TIMEOUT" "SOURCES;DEPENDS;INTERNALS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE tyndall_warnings ${ARG_DEPENDS} GTest::gtest GTest::gmock tyndall_test_support)
  tyndall_see_internals(${name} ${ARG_INTERNALS})
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
