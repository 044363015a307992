tyndall_test(passes_lattice LABEL passes
  SOURCES lattice_test.cpp ${CMAKE_SOURCE_DIR}/tests/physics/lattice_model.cpp
  DEPENDS tyndall_gl_test_support Tyndall::renderer tyndall_plugin_volumetric_gi)
