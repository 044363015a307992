tyndall_test(passes_traced LABEL passes SOURCES traced_test.cpp ../shaders/table_compute.cpp
  DEPENDS tyndall_gl_test_support tyndall_render_test_support tyndall_plugin_volumetric_gi Tyndall::tracing)
