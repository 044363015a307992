tyndall_test(unit_framegraph LABEL unit
  SOURCES framegraph_record_test.cpp framegraph_compile_test.cpp framegraph_cache_test.cpp framegraph_storage_test.cpp
          framegraph_dump_test.cpp framegraph_allocation_test.cpp framegraph_capture_test.cpp framegraph_fuzz_test.cpp
  DEPENDS Tyndall::framegraph nlohmann_json::nlohmann_json)
