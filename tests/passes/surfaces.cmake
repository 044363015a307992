tyndall_test(passes_surfaces LABEL passes DAILY -*/Osmesa*
  SOURCES surface_light_test.cpp surfaces_test.cpp
  DEPENDS tyndall_gl_test_support Tyndall::renderer INTERNALS renderer)
