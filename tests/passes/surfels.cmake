tyndall_test(passes_surfels LABEL passes DAILY -*/Osmesa* SOURCES surfel_intervals_test.cpp surfel_points_test.cpp
  DEPENDS tyndall_gl_test_support Tyndall::renderer tyndall_plugin_volumetric_gi INTERNALS renderer)
