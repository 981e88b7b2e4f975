"""What Python expressions and files of a workspace evaluate to.

None of them is run or imported.

It imports only the modules at the top of the package. Begin with `values.py` and `expressions.py`,
which xacro uses; `interpreter.py` adds the statements of a file.
"""
