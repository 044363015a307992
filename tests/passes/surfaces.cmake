tyndall_test(passes_surfaces LABEL passes
  SOURCES surface_light_test.cpp surfaces_test.cpp
  DEPENDS tyndall_gl_test_support Tyndall::renderer INTERNALS renderer)
