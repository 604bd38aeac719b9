# beambench_add_plugin(<target> <source>...): a shared object lib<target>.so to be loaded by
# `beambench --plugin`, in C++ (<beambench/plugin.hpp>) or in C (<beambench/contender.h>).
function(beambench_add_plugin target)
  add_library(${target} MODULE ${ARGN})
  target_link_libraries(${target} PRIVATE beambench::plugin)
  set_target_properties(${target} PROPERTIES PREFIX lib SUFFIX .so)
endfunction()
