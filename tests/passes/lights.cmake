tyndall_test(passes_lights LABEL passes DAILY -*/Osmesa*
  SOURCES lights_fixture.cpp lights_test.cpp shadows_cache_test.cpp shadows_soft_test.cpp shadows_test.cpp
  DEPENDS tyndall_gl_test_support Tyndall::renderer INTERNALS renderer)
