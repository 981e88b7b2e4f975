"""What agrees in a correct workspace: rules, a module for each subject.

`rule_table` has a row for each rule, `reading` runs all modules, and `names` joins the names that
they define and use. `name_problems`, `release_problems` and `file_problems` make problems of what
is found, and `name_fixes` finds the edits that fix names. All other modules find something.
"""
