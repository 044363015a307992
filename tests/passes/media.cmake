tyndall_test(passes_media_atlas LABEL passes SOURCES free_ranges_test.cpp media_atlas_test.cpp
  DEPENDS tyndall_gl_test_support Tyndall::renderer INTERNALS renderer)
