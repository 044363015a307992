tyndall_test(shaders_post LABEL shaders
  SOURCES tone_curves_test.cpp table_compute.cpp
  DEPENDS tyndall_gl_test_support Tyndall::renderer)
