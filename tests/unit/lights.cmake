tyndall_test(unit_lights LABEL unit SOURCES emissive_lights_test.cpp environment_lights_test.cpp medium_lights_test.cpp shadow_views_test.cpp DEPENDS Tyndall::renderer INTERNALS renderer)
