tyndall_test(unit_image LABEL unit
  SOURCES image_exr_test.cpp image_exr_windows_test.cpp image_hdr_test.cpp image_file_test.cpp image_metrics_test.cpp image_report_test.cpp
    image_display_metrics_test.cpp heat_map_test.cpp tone_curve_test.cpp
  DEPENDS Tyndall::core fmt::fmt PkgConfig::OPENEXR)
