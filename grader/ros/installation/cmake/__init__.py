"""What CMake and ament_cmake certainly do with a package's CMakeLists.txt, which is never run."""
