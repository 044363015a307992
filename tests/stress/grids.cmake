# The short form runs with every test run; the long one, `slow`, tries 1,000 copies of each kind of file.
tyndall_test(stress_grids LABEL stress SOURCES grid_damage_test.cpp DEPENDS Tyndall::media tyndall_volume_test_support)
tyndall_test(stress_grids_long SLOW LABEL stress TIMEOUT 3600 SOURCES grid_damage_test.cpp DEPENDS Tyndall::media tyndall_volume_test_support)
target_compile_definitions(stress_grids_long PRIVATE TYNDALL_LONG_RUN)
