tyndall_test(unit_transport LABEL unit SOURCES transport_plan_test.cpp DEPENDS Tyndall::transport)
