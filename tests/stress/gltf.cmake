tyndall_test(stress_gltf LABEL stress TIMEOUT 900
  SOURCES gltf_hostile_test.cpp scene_file_hostile_test.cpp
  DEPENDS Tyndall::scene)
