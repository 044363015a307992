tyndall_test(shaders_lighting LABEL shaders
  SOURCES lighting_brdf_test.cpp lighting_geometry_test.cpp lighting_texture_test.cpp lighting_upload_test.cpp table_compute.cpp
  DEPENDS tyndall_gl_test_support Tyndall::renderer INTERNALS renderer)
