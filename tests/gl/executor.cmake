include(embed_shaders)

tyndall_test(gl_executor LABEL gl
  SOURCES executor_compute_test.cpp executor_raster_test.cpp executor_lifetime_test.cpp executor_error_test.cpp
    executor_capture_test.cpp executor_indirect_test.cpp executor_tessellation_test.cpp
  DEPENDS tyndall_gl_test_support Tyndall::framegraph_gl)
# Embedded, and listed in variants.txt, as the shaders of the engine are.
tyndall_embed_shaders(TARGET gl_executor ROOT ${CMAKE_CURRENT_SOURCE_DIR}/shaders FUNCTION executorTestShaders)
