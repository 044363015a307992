# Patches of surfels and the tables of the interleaved framebuffer, no GL.
tyndall_test(unit_surfels LABEL unit SOURCES surfel_interleave_test.cpp surfel_patches_test.cpp DEPENDS Tyndall::builtin_plugins)
target_link_libraries(unit_surfels PRIVATE tyndall_plugin_volumetric_gi)
