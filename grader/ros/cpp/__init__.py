"""C++ as text: its syntax, literals, names and constants, read by tree-sitter, never compiled.

Preprocessor conditions, macros and templates of one's own are not evaluated.
"""
