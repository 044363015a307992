# What programs share, as far as it needs neither GL nor a program.
tyndall_test(unit_app LABEL unit SOURCES app_job_test.cpp app_options_test.cpp app_reference_test.cpp DEPENDS Tyndall::app CLI11::CLI11)
