"""What Python expressions and files of a workspace evaluate to, without running or importing any
of them.

It imports only the modules at the top of the package. Begin with `values.py` and `expressions.py`,
which xacro uses; `interpreter.py` adds the statements of a file.
"""
