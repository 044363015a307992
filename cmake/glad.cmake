# Makes the OpenGL 4.5 core loader from Debian's python3-glad when the project is configured, offline, and builds it as the
# static library `tyndall_glad`. Functions are loaded through the context's own get-proc-address.
set(TYNDALL_GLAD_EXTENSIONS
  GL_KHR_parallel_shader_compile        # shaders compiled by the driver's threads
  GL_EXT_texture_filter_anisotropic     # core only from 4.6 on
  GL_ARB_shader_draw_parameters         # gl_BaseInstanceARB, gl_DrawIDARB
  GL_ARB_shader_viewport_layer_array)   # gl_Layer from a vertex shader
list(JOIN TYNDALL_GLAD_EXTENSIONS "," glad_extensions)
set(glad_dir ${CMAKE_BINARY_DIR}/glad)
set(glad_request "gl:core=4.5 ${glad_extensions}")

set(glad_made "")
if(EXISTS ${glad_dir}/request.txt)
  file(READ ${glad_dir}/request.txt glad_made)
endif()
if(NOT glad_made STREQUAL glad_request)
  message(STATUS "Making the OpenGL loader with glad")
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env --unset=PYTHONPATH --unset=PYTHONHOME
      ${TYNDALL_PYTHON} -m glad --reproducible --quiet --api gl:core=4.5 --extensions ${glad_extensions} --out-path ${glad_dir} c
    RESULT_VARIABLE glad_status ERROR_VARIABLE glad_message OUTPUT_QUIET)
  if(NOT glad_status EQUAL 0)
    message(FATAL_ERROR "${TYNDALL_PYTHON} -m glad could not make the OpenGL loader; is the package python3-glad installed?\n${glad_message}")
  endif()
  file(WRITE ${glad_dir}/request.txt "${glad_request}")
endif()

add_library(tyndall_glad STATIC ${glad_dir}/src/gl.c)
target_include_directories(tyndall_glad SYSTEM PUBLIC ${glad_dir}/include)
target_compile_options(tyndall_glad PRIVATE -w)
