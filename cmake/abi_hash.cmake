# tyndall_abi_hash(OUTPUT header ROOTS header … FOLDERS folder …): writes a header with plugin::kHeadersHash, a hash of the text of the root headers
# and of all that they include by "…", looked up in the folders. Changed text configures anew, so the hash is never stale.
function(tyndall_abi_hash)
  cmake_parse_arguments(ARG "" "OUTPUT" "ROOTS;FOLDERS" ${ARGN})
  set(queue ${ARG_ROOTS})
  set(seen "")
  set(hashes "")
  while(queue)
    list(POP_FRONT queue header)
    if(header IN_LIST seen)
      continue()
    endif()
    list(APPEND seen ${header})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
    file(SHA256 ${header} hash)
    string(APPEND hashes ${hash})
    file(STRINGS ${header} includes REGEX "^#include \"")
    foreach(line ${includes})
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" name ${line})
      foreach(folder ${ARG_FOLDERS})
        if(EXISTS ${folder}/${name})
          list(APPEND queue ${folder}/${name})
        endif()
      endforeach()
    endforeach()
  endwhile()
  string(SHA256 hash "${hashes}")
  string(SUBSTRING ${hash} 0 16 hash)
  list(LENGTH seen count)
  file(CONFIGURE OUTPUT ${ARG_OUTPUT} @ONLY CONTENT
"#pragma once
// Made by cmake/abi_hash.cmake from @count@ headers.

#include <cstdint>

namespace tyndall::plugin {

/// Of the text of every header that crosses the plugin boundary.
inline constexpr uint64_t kHeadersHash = 0x@hash@ull;

} // namespace tyndall::plugin
")
endfunction()
