"""What a build of a package installs: package.xml, setup.py and CMakeLists.txt."""
