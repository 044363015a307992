tyndall_test(unit_lights LABEL unit SOURCES environment_lights_test.cpp shadow_views_test.cpp DEPENDS Tyndall::renderer)
