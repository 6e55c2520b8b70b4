# The ParaView plugin: build/lib/semsurf_paraview/semsurf_paraview.so, and the same below the prefix. PV_PLUGIN_PATH is
# that folder; semsurf's own libraries are inside the file, so that it may be moved.
if(NOT SEMSURF_PARAVIEW)
  return()
endif()
if(NOT SEMSURF_VTK OR NOT ParaView_FOUND)
  message(STATUS "No ParaView plugin: paraview-dev is not there, or SEMSURF_VTK is off")
  return()
endif()

# ParaView builds a plugin as something to load only where libraries are shared; ours all say STATIC.
set(BUILD_SHARED_LIBS ON)
paraview_plugin_scan(
  PLUGIN_FILES "${PROJECT_SOURCE_DIR}/paraview_plugin/paraview.plugin"
  PROVIDES_PLUGINS paraview_plugins
  ENABLE_BY_DEFAULT ON
  HIDE_PLUGINS_FROM_CACHE ON)
paraview_plugin_build(
  PLUGINS ${paraview_plugins}
  INSTALL_HEADERS OFF
  ADD_INSTALL_RPATHS OFF
  PLUGINS_COMPONENT paraview
  DISABLE_XML_DOCUMENTATION ON)   # that needs Qt; the texts are in the plugin all the same
unset(BUILD_SHARED_LIBS)
set(SEMSURF_PARAVIEW_FOLDER "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}/semsurf_paraview")
