tyndall_test(unit_scene LABEL unit
  SOURCES scene_camera_test.cpp scene_file_test.cpp scene_primitives_test.cpp scene_reach_test.cpp scene_gltf_samples_test.cpp scene_gltf_test.cpp scene_schema_test.cpp scene_volume_test.cpp scene_writer_test.cpp
  DEPENDS Tyndall::scene fmt::fmt nlohmann_json::nlohmann_json INTERNALS scene)
