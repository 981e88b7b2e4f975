"""C++ as text."""
