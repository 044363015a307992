# Puts shader sources into a program. As a module it gives
#
#   tyndall_embed_shaders(TARGET target ROOT folder FUNCTION name)
#
# which adds to `target` a generated source with `std::span<const tyndall::gl::EmbeddedShader> tyndall::gl::NAME()`: every shader
# below `folder` under its path relative to it. The source is made anew at build time when a shader changes; this same file,
# run as a script (cmake -P), makes it.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(TYNDALL_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
  function(tyndall_embed_shaders)
    cmake_parse_arguments(ARG "" "TARGET;ROOT;FUNCTION" "" ${ARGN})
    set(globs "")
    foreach(ending comp vert frag geom tesc tese glsl h)
      list(APPEND globs ${ARG_ROOT}/*.${ending})
    endforeach()
    file(GLOB_RECURSE files CONFIGURE_DEPENDS ${globs} ${ARG_ROOT}/variants.txt)
    list(SORT files)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/${ARG_FUNCTION}.cpp)
    list(JOIN files "\n" listing)
    file(CONFIGURE OUTPUT ${output}.list CONTENT "${listing}" @ONLY)
    add_custom_command(OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} -DROOT=${ARG_ROOT} -DLIST=${output}.list -DOUTPUT=${output} -DFUNCTION=${ARG_FUNCTION} -P ${TYNDALL_EMBED_SCRIPT}
      DEPENDS ${files} ${output}.list ${TYNDALL_EMBED_SCRIPT}
      COMMENT "Embedding the shaders of ${ARG_ROOT}" VERBATIM)
    target_sources(${ARG_TARGET} PRIVATE ${output})
  endfunction()
  return()
endif()

file(STRINGS ${LIST} files)
set(code "// Made by cmake/embed_shaders.cmake.\n#include \"gl/embedded_shaders.h\"\n\nnamespace tyndall::gl {\nnamespace {\nconst EmbeddedShader kShaders[] = {\n")
set(count 0)
foreach(file IN LISTS files)
  file(RELATIVE_PATH path ${ROOT} ${file})
  file(READ ${file} text)
  string(APPEND code "{\"${path}\", R\"TYNDALL_GLSL(${text})TYNDALL_GLSL\"},\n")
  math(EXPR count "${count} + 1")
endforeach()
# The last entry keeps the array from being empty; it is not part of the span.
string(APPEND code "{nullptr, nullptr}};\n} // namespace\n\nstd::span<const EmbeddedShader> ${FUNCTION}() { return {kShaders, ${count}}; }\n\n} // namespace tyndall::gl\n")
file(WRITE ${OUTPUT} "${code}")
