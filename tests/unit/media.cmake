tyndall_test(unit_media LABEL unit
  SOURCES media_blackbody_test.cpp media_bricks_test.cpp media_integral_test.cpp media_particle_grids_test.cpp media_particles_test.cpp
    media_phase_test.cpp media_sampling_test.cpp
  DEPENDS Tyndall::media INTERNALS media)

# OpenVDB and NanoVDB themselves write files for tests and say what is in them.
pkg_check_modules(IMATH REQUIRED IMPORTED_TARGET Imath)
add_library(tyndall_volume_test_support STATIC media_volume_files.cpp)
target_include_directories(tyndall_volume_test_support PUBLIC ${CMAKE_CURRENT_LIST_DIR})
target_compile_definitions(tyndall_volume_test_support PRIVATE NANOVDB_USE_ZIP NANOVDB_USE_BLOSC)
target_link_libraries(tyndall_volume_test_support PRIVATE tyndall_warnings ${OPENVDB_LIBRARY} ${BLOSC_LIBRARY}
  PkgConfig::IMATH ZLIB::ZLIB TBB::tbb Tyndall::core)

# It runs once and takes minutes to optimise.
set_source_files_properties(media_volume_files.cpp PROPERTIES COMPILE_OPTIONS -O0)

tyndall_test(unit_media_import LABEL unit SOURCES media_cut_test.cpp media_import_test.cpp media_nanovdb_versions_test.cpp
  DEPENDS Tyndall::media tyndall_volume_test_support)
