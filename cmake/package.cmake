# Install rules: programs in bin/, plugins as shared libraries in lib/tyndall/plugins/, shaders and scenes in share/tyndall/.
# cmake/package.sh turns an installation into a folder that runs anywhere, and packs it.
foreach(program tyndall tyndall-grid-reader tyndall-editor)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION bin)
  endif()
endforeach()

get_property(plugins GLOBAL PROPERTY TYNDALL_PLUGINS)
foreach(plugin ${plugins})
  install(TARGETS tyndall_plugin_${plugin}_shared LIBRARY DESTINATION lib/tyndall/plugins)
endforeach()

install(DIRECTORY shaders DESTINATION share/tyndall)
install(DIRECTORY content DESTINATION share/tyndall)
install(FILES README.md LICENSE CHANGELOG.md DESTINATION share/doc/tyndall)
