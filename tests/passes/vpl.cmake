tyndall_test(passes_vpl_maps LABEL passes SOURCES vpl_maps_test.cpp
  DEPENDS tyndall_gl_test_support tyndall_render_test_support tyndall_plugin_volumetric_gi Tyndall::reference TBB::tbb)
target_include_directories(passes_vpl_maps PRIVATE ${CMAKE_SOURCE_DIR}/plugins)
