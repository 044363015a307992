# tyndall_plugin(name SOURCES …): builds a plugin twice, as a static library for the list of built-in plugins and as a shared
# library `lib/plugins/name.so` that --plugin loads. The sources are the same; only the entry point's name differs, in the first of them.
# It sees its own headers as "name/…", and those of Tyndall::plugin and of DEPENDS.
function(tyndall_plugin name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  set(own ${CMAKE_BINARY_DIR}/include/plugin_${name})
  file(MAKE_DIRECTORY ${own})
  if(NOT EXISTS ${own}/${name})
    file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${own}/${name} SYMBOLIC)
  endif()
  tyndall_check_arrows(plugin_any ${ARG_DEPENDS})
  # All but the entry point is compiled once.
  set(parts ${ARG_SOURCES})
  list(POP_FRONT parts entry)
  set(objects "")
  if(parts)
    add_library(tyndall_plugin_${name}_parts OBJECT ${parts})
    set(objects $<TARGET_OBJECTS:tyndall_plugin_${name}_parts>)
  endif()
  add_library(tyndall_plugin_${name} STATIC ${entry} ${objects})
  add_library(tyndall_plugin_${name}_shared MODULE ${entry} ${objects})
  target_compile_definitions(tyndall_plugin_${name}_shared PRIVATE TYNDALL_PLUGIN_SHARED)
  set_target_properties(tyndall_plugin_${name}_shared PROPERTIES PREFIX "" OUTPUT_NAME ${name}
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/plugins)
  target_link_options(tyndall_plugin_${name}_shared PRIVATE -Wl,--exclude-libs,ALL)
  foreach(target tyndall_plugin_${name} tyndall_plugin_${name}_shared tyndall_plugin_${name}_parts)
    if(NOT TARGET ${target})
      continue()
    endif()
    set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    target_include_directories(${target} PUBLIC ${own})
    target_link_libraries(${target} PRIVATE tyndall_warnings PUBLIC Tyndall::plugin ${ARG_DEPENDS})
  endforeach()
  set_property(GLOBAL APPEND PROPERTY TYNDALL_PLUGINS ${name})
endfunction()

# A source file with the entry points of every plugin declared so far, as the target Tyndall::builtin_plugins.
function(tyndall_builtin_plugins)
  get_property(names GLOBAL PROPERTY TYNDALL_PLUGINS)
  set(declarations "")
  set(entries "")
  foreach(name ${names})
    string(APPEND declarations "extern \"C\" const tyndall::plugin::PluginDescriptor* tyndall_plugin_${name}();\n")
    string(APPEND entries "    tyndall_plugin_${name},\n")
  endforeach()
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/builtin_plugins.cpp @ONLY CONTENT
"// Made by cmake/plugin.cmake from the plugins declared in plugins/CMakeLists.txt.
#include \"plugin/builtin_plugins.h\"

@declarations@
namespace tyndall::plugin {

static const EntryPoint kEntryPoints[] = {
@entries@};

std::span<const EntryPoint> builtinPlugins() { return kEntryPoints; }

} // namespace tyndall::plugin
")
  add_library(tyndall_builtin_plugins STATIC ${CMAKE_BINARY_DIR}/generated/builtin_plugins.cpp)
  add_library(Tyndall::builtin_plugins ALIAS tyndall_builtin_plugins)
  list(TRANSFORM names PREPEND tyndall_plugin_ OUTPUT_VARIABLE libraries)
  target_link_libraries(tyndall_builtin_plugins PUBLIC Tyndall::plugin PRIVATE ${libraries})
endfunction()
