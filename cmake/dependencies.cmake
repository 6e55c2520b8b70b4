# Every find_package of the project. The README's table says what each is for.
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
find_package(CGAL 5.5 REQUIRED)
# CONFIG: CGAL brings a FindOpenMesh of its own.
find_package(OpenMesh REQUIRED CONFIG)
find_package(embree 3 REQUIRED)
find_package(OpenImageIO REQUIRED)
# Debian's target names an OpenCV include folder that its package does not bring.
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "")
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(pugixml REQUIRED)
find_package(ZLIB REQUIRED)
find_package(CLI11 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo cairo-svg cairo-pdf)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
if(SEMSURF_TESTS)
  find_package(GTest REQUIRED)
endif()

# One VTK per program: ParaView's own where its development files are, else the system's.
if(SEMSURF_VTK)
  find_package(ParaView QUIET COMPONENTS RemotingCore)
  if(ParaView_FOUND)
    find_package(VTK REQUIRED COMPONENTS CommonCore CommonDataModel IOXML
                 PATHS "${ParaView_DIR}/vtk" NO_DEFAULT_PATH)
  else()
    find_package(VTK REQUIRED COMPONENTS CommonCore CommonDataModel IOXML)
  endif()
endif()
