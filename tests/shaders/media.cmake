# Both back ends have the same compiler here: one of them is enough for every day.
tyndall_test(shaders_media LABEL shaders DAILY -*/Osmesa* TIMEOUT 900
  SOURCES media_compute.cpp table_compute.cpp media_depth_test.cpp media_functions_test.cpp media_march_test.cpp
  DEPENDS tyndall_gl_test_support Tyndall::renderer INTERNALS renderer)

tyndall_test(shaders_media_passes LABEL shaders DAILY -*/Osmesa* TIMEOUT 900
  SOURCES media_compute.cpp table_compute.cpp media_passes_test.cpp
  DEPENDS tyndall_gl_test_support Tyndall::renderer INTERNALS renderer)
