tyndall_test(passes_surfaces LABEL passes
  SOURCES surfaces_test.cpp
  DEPENDS tyndall_gl_test_support Tyndall::renderer)
