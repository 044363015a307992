tyndall_test(gl_executor LABEL gl
  SOURCES executor_compute_test.cpp executor_raster_test.cpp executor_lifetime_test.cpp executor_error_test.cpp
  DEPENDS tyndall_gl_test_support Tyndall::framegraph_gl)
