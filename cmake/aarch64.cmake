# scripts/test_aarch64: compiles for aarch64 against the Debian packages in
# FINRAY_SYSROOT, and runs what it compiles in QEMU.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
# CMake also reads this file for its trials of the compiler.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES FINRAY_SYSROOT)
set(CMAKE_SYSROOT ${FINRAY_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${FINRAY_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR}
  ${FINRAY_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${FINRAY_SYSROOT}/usr/share/pkgconfig)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L ${FINRAY_SYSROOT})
