# SPDX-License-Identifier: GPL-3.0-or-later
# Builds for AArch64 on another machine: g++-aarch64-linux-gnu, or clang where SEMSURF_AARCH64_CLANG is on. Libraries are
# those that sysroot.sh unpacked into SEMSURF_AARCH64_SYSROOT; programs run under qemu-user. docs/development/testing.md
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(triple aarch64-linux-gnu)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES SEMSURF_AARCH64_SYSROOT SEMSURF_AARCH64_CLANG)

set(CMAKE_SYSROOT "${SEMSURF_AARCH64_SYSROOT}")
set(CMAKE_LIBRARY_ARCHITECTURE ${triple})
if(SEMSURF_AARCH64_CLANG)
  set(CMAKE_C_COMPILER clang)
  set(CMAKE_CXX_COMPILER clang++)
  set(CMAKE_C_COMPILER_TARGET ${triple})
  set(CMAKE_CXX_COMPILER_TARGET ${triple})
else()
  set(CMAKE_C_COMPILER ${triple}-gcc)
  set(CMAKE_CXX_COMPILER ${triple}-g++)
endif()
set(CMAKE_CROSSCOMPILING_EMULATOR "qemu-aarch64;-L;${SEMSURF_AARCH64_SYSROOT}")

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} "${SEMSURF_AARCH64_SYSROOT}")
set(ENV{PKG_CONFIG_LIBDIR} "${SEMSURF_AARCH64_SYSROOT}/usr/lib/${triple}/pkgconfig:${SEMSURF_AARCH64_SYSROOT}/usr/share/pkgconfig")
