# The editor as a user runs it, and the parts of it that need neither window nor GL.
if(TARGET tyndall-editor)
  tyndall_test(unit_editor LABEL unit SOURCES editor_model_test.cpp editor_input_test.cpp DEPENDS Tyndall::editor_model)
  tyndall_test(unit_editor_widgets LABEL unit SOURCES editor_widgets_test.cpp DEPENDS Tyndall::editor_widgets tyndall_test_support)
  tyndall_test(programs_editor LABEL programs SOURCES editor_test.cpp editor_drive_test.cpp DEPENDS tyndall_programs_support)
  add_dependencies(programs_editor tyndall tyndall-editor tyndall-grid-reader)
endif()
